// SPDX-License-Identifier: Apache-2.0
// Real models are framed and shaded as their files state.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "relief/shade/effects.h"
#include "relief/shade/scene_file.h"
#include "shade/render/draw_support.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;

namespace {

struct Model {
    const char* file;
    bool normal_map;
    std::size_t textures;  ///< The number of distinct images that the plan uploads, and of tables.
};

class RealModels : public test::DrawTest, public ::testing::WithParamInterface<Model> {};

/// The bounding box of the covered pixels as shares of the picture, and their number.
struct Coverage {
    double share = 0.0;
    int left = 1000000, right = -1, top = 1000000, bottom = -1;
};

Coverage coverage(const Image& image) {
    Coverage result;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (test::pixel(image, x, y).a == 0.0) continue;
            result.share += 1.0 / (image.width * image.height);
            result.left = std::min(result.left, x);
            result.right = std::max(result.right, x);
            result.top = std::min(result.top, y);
            result.bottom = std::max(result.bottom, y);
        }
    }
    return result;
}

TEST_P(RealModels, AreFramedAndShadedAsTheirFilesState) {
    RELIEF_NEEDS_SHARED(file, std::string("data/models/") + GetParam().file);
    Report report;
    Scene scene = load_scene(file, report);
    scene.directional_lights = {{{-0.5F, -1.0F, -0.8F}, glm::vec3(0.8F)}};
    scene.ambient = glm::vec3(0.1F);
    scene.camera = framed(world_bounds(scene), 0.5F, 0.3F, 0.6F, 1.0F);
    Renderer renderer(context(), scene, {160, 160, 1, OutputCoding::srgb}, report);
    const Frame frame = renderer.draw(*scene.camera);
    bool normal_map = false;
    for (const DrawPlan& draw : renderer.plan().draws)
        normal_map |= draw.features.detail == NormalDetail::normal_map;
    EXPECT_EQ(normal_map, GetParam().normal_map);
    EXPECT_EQ(frame.textures, GetParam().textures);

    const Coverage covered = coverage(frame.image);
    EXPECT_GT(covered.share, 0.05);
    EXPECT_GT(covered.left, 0);
    EXPECT_GT(covered.top, 0);
    EXPECT_LT(covered.right, 159);
    EXPECT_LT(covered.bottom, 159);
    double brightest = 0.0;
    for (int y = 0; y < 160; ++y) {
        for (int x = 0; x < 160; ++x)
            brightest = std::max(brightest, test::pixel(frame.image, x, y).g);
    }
    EXPECT_GT(brightest, 60.0);
}

std::string model_name(const ::testing::TestParamInfo<Model>& model) {
    return std::filesystem::path(model.param.file).stem().string();
}

INSTANTIATE_TEST_SUITE_P(
    Of, RealModels,
    ::testing::Values(Model{"gltf/WaterBottle/glTF/WaterBottle.gltf", true, 5},
                      Model{"gltf/BoomBox/glTF/BoomBox.gltf", true, 5},
                      Model{"gltf/Avocado/glTF/Avocado.gltf", true, 4},
                      Model{"gltf/NegativeScaleTest/glTF-Binary/NegativeScaleTest.glb", false, 3},
                      Model{"obj/spot/spot_triangulated.obj", false, 0},
                      Model{"obj/scorpion.obj", false, 0}, Model{"obj/fuze/fuze.obj", false, 1},
                      Model{"ply/lego.ply", false, 0}),
    model_name);

}  // namespace
}  // namespace relief
