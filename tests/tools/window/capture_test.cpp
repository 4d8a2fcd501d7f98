// SPDX-License-Identifier: Apache-2.0
// Pictures, scenes and models that are saved, and the pictures that saved files draw.
#include "window/capture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/image_compare.h"
#include "support/gl_environment.h"
#include "support/labels.h"
#include "support/shapes.h"
#include "tools/workplace.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

using test::Workplace;
using testing::HasSubstr;

class Capturing : public testing::Test {
  protected:
    void SetUp() override {
        context_ = test::context_if_installed(Backend::osmesa);
        if (!context_) GTEST_SKIP() << "needs OSMesa";
        cache_ = std::make_unique<RenderCache>(*context_);
    }

    [[nodiscard]] CaptureRequest request_of(const std::string& name) const {
        auto scene = std::make_shared<Scene>();
        scene->meshes.push_back(test::cube());
        Instance instance;
        instance.world_from_object[3] = {1, 0, 0, 1};  // Not in the center.
        scene->instances.push_back(instance);
        scene->ambient = glm::vec3(1.0F);
        scene->background = {0, 0, 1, 1};
        CaptureRequest request;
        request.scene = scene;
        request.settings = {40, 30, 1};
        request.camera.world_from_view[3] = {0, 0, 8, 1};
        request.file = workplace_ / name;
        return request;
    }

    /// Runs the task to its end. \return the number of steps
    int finish(CaptureRequest request, const std::shared_ptr<CaptureProgress>& progress) {
        const DrawTask task = capture_task(std::move(request), progress);
        int steps = 1;
        while (task(*context_, *cache_))
            ++steps;
        return steps;
    }
    const Workplace& workplace() { return workplace_; }

  private:
    Workplace workplace_;
    std::unique_ptr<Context> context_;
    std::unique_ptr<RenderCache> cache_;
};

TEST_F(Capturing, WritesOnePictureInItsSize) {
    const auto progress = std::make_shared<CaptureProgress>();
    EXPECT_EQ(text_of(progress->state()), "");
    EXPECT_EQ(finish(request_of("out/a.png"), progress), 1);
    const Image image = read_image(workplace() / "out/a.png", ImageUse::color);
    EXPECT_EQ(image.width, 40);
    EXPECT_EQ(image.height, 30);
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.as<std::uint8_t>()[2], 255) << "the background";
    EXPECT_THAT(text_of(progress->state()), HasSubstr("Saved "));
    EXPECT_EQ(workplace().outputs(), "a.png");
}

TEST_F(Capturing, TransparentPictureHasAlphaAndNoBackground) {
    const auto progress = std::make_shared<CaptureProgress>();
    CaptureRequest request = request_of("out/a.png");
    request.transparent = true;
    finish(request, progress);
    const Image image = read_image(workplace() / "out/a.png", ImageUse::color);
    ASSERT_EQ(image.channels, 4);
    EXPECT_EQ(image.as<std::uint8_t>()[3], 0);
}

TEST_F(Capturing, TurntableWritesNumberedFilesAndRotatesTheModel) {
    const auto progress = std::make_shared<CaptureProgress>();
    CaptureRequest request = request_of("out/turn.png");
    request.turntable = 4;
    EXPECT_EQ(finish(request, progress), 4);
    EXPECT_EQ(workplace().outputs(), "turn-0001.png turn-0002.png turn-0003.png turn-0004.png");
    EXPECT_EQ(progress->state().done, 4);
    // The model is on the right side, and after half a turn on the left side.
    const auto right_half_is_background = [&](const char* name) {
        const Image image = read_image(workplace() / name, ImageUse::color);
        return image.as<std::uint8_t>()[3 * (15 * 40 + 24)] == 0;
    };
    EXPECT_FALSE(right_half_is_background("out/turn-0001.png"));
    EXPECT_TRUE(right_half_is_background("out/turn-0003.png"));
}

TEST_F(Capturing, WriteErrorIsReportedAndStopsTheTask) {
    const auto progress = std::make_shared<CaptureProgress>();
    CaptureRequest request = request_of("out/missing/a.png");
    request.turntable = 4;
    EXPECT_EQ(finish(request, progress), 1);
    EXPECT_THAT(text_of(progress->state()), HasSubstr("Not saved: "));
    EXPECT_EQ(workplace().outputs(), "");
}

TEST_F(Capturing, TakesTheNextFreeName) {
    EXPECT_EQ(free_file("models/vase.obj", 0), "models/vase-1.png");
    workplace().write("out/vase-1.png", "");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 0), workplace() / "out/vase-2.png");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 3), workplace() / "out/vase-turn-1.png");
    workplace().write("out/vase-turn-1-0001.png", "");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 3), workplace() / "out/vase-turn-2.png");
    workplace().write("out/vase-turn-2-0003.png", "");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 2), workplace() / "out/vase-turn-2.png");
    EXPECT_EQ(free_file(workplace() / "out/vase.obj", 3), workplace() / "out/vase-turn-3.png");
}

constexpr const char* small = " --size 120x90 --samples 1 ";

/// The number of pixels that differ between the pictures of two command lines.
std::size_t differing(const Workplace& workplace, const std::string& a, const std::string& b) {
    const test::ProgramResult first = workplace.run("relief-view " + a + " --output a.png");
    const test::ProgramResult second = workplace.run("relief-view " + b + " --output b.png");
    EXPECT_EQ(first.exit_code, 0) << first.error;
    EXPECT_EQ(second.exit_code, 0) << second.error;
    return compare(read_image(workplace / "a.png", ImageUse::color),
                   read_image(workplace / "b.png", ImageUse::color))
        .differing_pixels;
}

TEST_LABELS(slow);
TEST(SavedScene, DrawsTheSamePixelsForAllOptions) {
    const Workplace workplace;
    for (const std::string options :
         {"",
          "--material gold --light point:2,2,2,4,#ff8040 --camera 10,40@0.1,0.6,0,2.5 --fov 41.7",
          "--height-map data/bricks-height.png --strength 9 --ambient 0.2 --exposure 0.7 "
          "--tone-mapping aces",
          "--height-map data/bricks-height.png --height-as bump_map", "--interpolation flat",
          "--environment data/sky --reflectivity 0.4 --light spot:2,3,2,0,0,0,23,5 --no-skybox",
          "--diffuse-map data/bricks-diffuse.png --shininess 80 --background '#204060'"}) {
        const std::string line = "data/vase.obj" + std::string(small) + options;
        ASSERT_EQ(workplace.run("relief-view " + line + " --save-scene saved.json").exit_code, 0);
        EXPECT_EQ(differing(workplace, line, "saved.json --samples 1"), 0U) << options;
        std::filesystem::remove(workplace / "saved.json");
        std::filesystem::remove(workplace / "saved-image-1.png");
    }
    // glTF materials are metallic-roughness, which a classic material replaces.
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj vase.glb").exit_code, 0);
    const std::string gold = "vase.glb" + std::string(small) + "--material gold";
    ASSERT_EQ(workplace.run("relief-view " + gold + " --save-scene saved.json").exit_code, 0);
    EXPECT_EQ(differing(workplace, gold, "saved.json --samples 1"), 0U);
}

TEST_LABELS(slow);
TEST(SavedScene, StaysInTheFolderOfItsSceneFile) {
    const Workplace workplace;
    // data/ belongs to the sources and must not change.
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

TEST(SavedModel, HasTheMapsThatItIsDrawnWith) {
    const Workplace workplace;
    const std::string line = "relief-view data/vase.obj --save-model vase.glb ";
    const std::string map = "data/scenes/bricks-normal.png";
    ASSERT_EQ(workplace.run(line + "--normal-map " + map + " --normal-scale 0.5").exit_code, 0);
    Report report;
    const GltfView view = GltfDocument::read(workplace / "vase.glb", report).view();
    ASSERT_TRUE(view.materials.front().normal_map);
    EXPECT_EQ(view.materials.front().normal_map->scale, 0.5F);
    // Maps that glTF cannot hold are refused, and nothing is written.
    std::filesystem::remove(workplace / "vase.glb");
    for (const std::string& words :
         {"--normal-map " + map + " --green down", "--normal-map " + map + " --normal-space object",
          std::string("--height-map data/bricks-height.png")}) {
        const test::ProgramResult refused = workplace.run(line + words);
        EXPECT_EQ(refused.exit_code, 2) << words;
        EXPECT_THAT(refused.error, HasSubstr("--save-model: ")) << words;
    }
    EXPECT_FALSE(std::filesystem::exists(workplace / "vase.glb"));
}

}  // namespace
}  // namespace relief::tools
