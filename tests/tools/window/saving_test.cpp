// SPDX-License-Identifier: Apache-2.0
// Scenes and models saved by options, and what they then draw.
#include "window/saving.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::Workplace;
using testing::HasSubstr;

constexpr const char* small = " --size 120x90 --samples 1 ";

/// Pixels that differ between what two lines draw.
std::size_t differing(const Workplace& workplace, const std::string& a, const std::string& b) {
    const test::ProgramResult first = workplace.run("relief-view " + a + " --output a.png");
    const test::ProgramResult second = workplace.run("relief-view " + b + " --output b.png");
    EXPECT_EQ(first.exit_code, 0) << first.error;
    EXPECT_EQ(second.exit_code, 0) << second.error;
    return compare(read_image(workplace / "a.png", ImageUse::color),
                   read_image(workplace / "b.png", ImageUse::color))
        .differing_pixels;
}

TEST(SavedScene, DrawsTheSamePixelsWhateverTheOptionsChanged) {
    const Workplace workplace;
    for (const std::string options :
         {"",
          "--material gold --light point:2,2,2,4,#ff8040 --camera 10,40@0.1,0.6,0,2.5 --fov 41.7",
          "--height-map data/bricks-height.png --strength 9 --ambient 0.2 --exposure 0.7 "
          "--tone-mapping aces",
          "--height-map data/bricks-height.png --height-as bump_map --interpolation flat",
          "--environment data/sky --reflectivity 0.4 --light spot:2,3,2,0,0,0,23,5 --no-skybox",
          "--diffuse-map data/bricks-diffuse.png --shininess 80 --background '#204060'"}) {
        const std::string line = "data/vase.obj" + std::string(small) + options;
        ASSERT_EQ(workplace.run("relief-view " + line + " --save-scene saved.json").exit_code, 0);
        EXPECT_EQ(differing(workplace, line, "saved.json --samples 1"), 0U) << options;
        std::filesystem::remove(workplace / "saved.json");
        std::filesystem::remove(workplace / "saved-image-1.png");
    }
}

TEST(SavedScene, OfASceneFileStandsBesideItAndCanBeSavedAgain) {
    const Workplace workplace;
    // data/ is the sources' own, where nothing is to be written.
    std::filesystem::copy(workplace / "data", workplace / "mine",
                          std::filesystem::copy_options::recursive);
    const std::string line = "mine/scenes/lighting-and-environment.json --samples 1 ";
    const std::string edits = "--ambient 0.3 --light directional:20,50,0.8 ";
    const std::string saved = "mine/scenes/saved.json";
    ASSERT_EQ(workplace.run("relief-view " + line + edits + "--save-scene " + saved).exit_code, 0);
    EXPECT_EQ(differing(workplace, line + edits, saved + " --samples 1"), 0U);
    ASSERT_EQ(
        workplace
            .run("relief-view " + saved + " --exposure 1 --save-scene mine/scenes/saved-2.json")
            .exit_code,
        0);
    EXPECT_EQ(differing(workplace, saved + " --samples 1 --exposure 1",
                        "mine/scenes/saved-2.json --samples 1"),
              0U);
    const test::ProgramResult elsewhere =
        workplace.run("relief-view " + line + "--save-scene saved.json");
    EXPECT_EQ(elsewhere.exit_code, 1);
    EXPECT_THAT(elsewhere.error, HasSubstr("in its own folder only"));
}

TEST(SavedModel, HasTheFramesThatItIsDrawnWithAndDrawsTheSame) {
    const Workplace workplace;
    const std::string model = "data/scenes/pot.glb";
    ASSERT_EQ(workplace.run("relief-view " + model + " --save-model saved.glb").exit_code, 0);
    EXPECT_EQ(differing(workplace, model + small, "saved.glb" + std::string(small)), 0U);
    ASSERT_EQ(workplace.run("relief-view data/vase.obj --save-model vase.glb").exit_code, 0);
    Report report;
    const GltfDocument vase = GltfDocument::read(workplace / "vase.glb", report);
    EXPECT_FALSE(vase.mesh(vase.triangle_primitives().front()).normals.empty());
    EXPECT_EQ(workplace.run("relief-view data/vase.obj --save-model data/vase.obj").exit_code, 2);
}

}  // namespace
}  // namespace relief::tools
