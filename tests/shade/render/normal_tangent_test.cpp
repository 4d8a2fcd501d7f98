// SPDX-License-Identifier: Apache-2.0
// Khronos' NormalTangentTest and NormalTangentMirrorTest: each row holds half spheres as real
// geometry and, beside them, flat squares with a normal map of the same shape, turned and mirrored
// in texture space. Both must shade alike. Here the normal that shading used is recovered from each
// pixel and compared by angle, cell by cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "draw_test.h"
#include "relief/shade/scene_file.h"
#include "support/angle.h"
#include "support/shared_data.h"

namespace relief {
namespace {

/// Cells are 0.3 wide; half spheres have a radius of 0.096 around their centre.
constexpr float cell_half_width = 0.15F;
constexpr int cell_pixels = 120;
/// Compared within this share of the sphere's radius: beyond, a pixel of the picture, and of the
/// map, spans many degrees.
constexpr double compared_radius = 0.06 / 0.15;

/// Degrees. Found: 0.48 and 1.1 in both models. The geometry is a coarse half sphere whose
/// interpolated normals leave the true one by about that much, and the map has 8 bits.
constexpr double mean_tolerance = 0.6;
constexpr double max_tolerance = 1.5;

/// The lights' directions, each shining in one channel: 30 degrees off z, so that all reach every
/// normal within 60 degrees of z.
const glm::mat3& light_axes() {
    static const glm::mat3 axes = [] {
        glm::mat3 result;
        for (int i = 0; i < 3; ++i) {
            const float turn = 2.0943951F * static_cast<float>(i);
            result[i] = {0.5F * std::cos(turn), 0.5F * std::sin(turn), std::sqrt(0.75F)};
        }
        return result;
    }();
    return axes;
}

/// The model with its geometry and normal map, but white, under one coloured light an axis.
Scene normals_made_visible(const std::filesystem::path& file) {
    Report report;
    Scene scene = load_scene(file, report);
    for (Material& material : scene.materials) {
        const std::optional<NormalMap> map = material.normal_map;
        material = test::black_material();
        material.diffuse = glm::vec3(1.0F);
        material.normal_map = map;
    }
    for (int i = 0; i < 3; ++i) {
        glm::vec3 channel(0.0F);
        channel[i] = 1.0F;
        scene.directional_lights.push_back({-light_axes()[i], channel});
    }
    scene.camera = Camera{};
    scene.camera->vertical_fov = 2.0F * std::atan(cell_half_width / 40.0F);  // Nearly parallel.
    scene.camera->near = 39.0F;
    scene.camera->far = 41.0F;
    return scene;
}

struct Difference {
    double mean = 0.0;
    double max = 0.0;
};

/// Degrees between the normals of two cells, over the sphere's inner part.
Difference degrees(const Image& a, const Image& b) {
    const glm::dmat3 normal_from_light = glm::inverse(glm::transpose(glm::dmat3(light_axes())));
    Difference result;
    int count = 0;
    for (int y = 0; y < cell_pixels; ++y) {
        for (int x = 0; x < cell_pixels; ++x) {
            const glm::dvec2 at = glm::dvec2(x + 0.5, y + 0.5) / (0.5 * cell_pixels) - 1.0;
            if (glm::length(at) > compared_radius) continue;
            const double angle =
                test::degrees_between(normal_from_light * glm::dvec3(test::pixel(a, x, y)),
                                      normal_from_light * glm::dvec3(test::pixel(b, x, y)));
            result.mean += angle;
            result.max = std::max(result.max, angle);
            ++count;
        }
    }
    result.mean /= count;
    return result;
}

class NormalTangent : public test::DrawTest {
  protected:
    /// Compares, in five rows, the geometry at x = `geometry` with each of `mapped`.
    Difference worst_difference(const std::filesystem::path& file,
                                const std::vector<std::vector<float>>& groups) const {
        const Scene scene = normals_made_visible(file);
        Report report;
        Renderer renderer(context(), scene, {cell_pixels, cell_pixels, 1, OutputCoding::linear},
                          report);
        const auto cell = [&](float x, float y) {
            Camera camera = *scene.camera;
            camera.world_from_view[3] = glm::vec4(x + cell_half_width, y, 40, 1);
            return renderer.draw(camera).image;
        };
        Difference worst;
        for (const std::vector<float>& group : groups) {
            for (const float y : {0.8F, 0.4F, 0.0F, -0.4F, -0.8F}) {
                const Image geometry = cell(group[0], y);
                for (std::size_t i = 1; i < group.size(); ++i) {
                    const Difference difference = degrees(geometry, cell(group[i], y));
                    worst.mean = std::max(worst.mean, difference.mean);
                    worst.max = std::max(worst.max, difference.max);
                }
            }
        }
        RecordProperty("worst_mean_degrees", std::to_string(worst.mean));
        RecordProperty("worst_max_degrees", std::to_string(worst.max));
        return worst;
    }
};

TEST_F(NormalTangent, GeometryAndNormalMapShadeAlikeWithComputedTangents) {
    RELIEF_NEEDS_SHARED(file,
                        "data/models/gltf/NormalTangentTest/glTF-Binary/NormalTangentTest.glb");
    const Difference worst =
        worst_difference(file, {{-1.11F, -0.79F}, {-0.31F, 0.01F}, {0.49F, 0.81F}});
    EXPECT_LE(worst.mean, mean_tolerance);
    EXPECT_LE(worst.max, max_tolerance);
}

TEST_F(NormalTangent, GeometryAndMirroredNormalMapsShadeAlikeWithAuthoredTangents) {
    RELIEF_NEEDS_SHARED(
        file, "data/models/gltf/NormalTangentMirrorTest/glTF-Binary/NormalTangentMirrorTest.glb");
    const Difference worst = worst_difference(
        file, {{-1.4246F, -1.1046F, -0.7793F, -0.4412F}, {0.1499F, 0.4699F, 0.7908F, 1.1136F}});
    EXPECT_LE(worst.mean, mean_tolerance);
    EXPECT_LE(worst.max, max_tolerance);
}

}  // namespace
}  // namespace relief
