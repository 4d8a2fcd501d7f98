// SPDX-License-Identifier: Apache-2.0
// The difference of a model from its source: equal models have none, and each planted fault raises
// a figure far above the noise floor.
#include "relief/shade/fidelity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "relief/mesh/execution.h"
#include "relief/shade/image_compare.h"
#include "shade/render/draw_support.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

class FidelityTest : public test::DrawTest {};

constexpr FidelityOptions small_pictures{.size = 64, .samples = 4, .views = 6};
constexpr int map_size = 64;
constexpr auto studio = static_cast<std::size_t>(FidelityLight::studio);
constexpr auto grazing = static_cast<std::size_t>(FidelityLight::grazing);
constexpr auto base_color = static_cast<std::size_t>(FidelityLight::base_color);

/// A normal map of waves along both axes.
Image wave_map() {
    Image map = make_image(map_size, map_size, 3, 8, ColorSpace::data);
    const std::span<std::uint8_t> samples = map.as<std::uint8_t>();
    const double step = 2.0 * std::numbers::pi / map_size;
    for (int y = 0; y < map_size; ++y) {
        for (int x = 0; x < map_size; ++x) {
            const glm::dvec3 normal =
                glm::normalize(glm::dvec3(0.5 * std::sin(6.0 * step * (x + 0.5)),
                                          0.5 * std::sin(4.0 * step * (y + 0.5)), 1.0));
            for (int channel = 0; channel < 3; ++channel) {
                samples[static_cast<std::size_t>(3 * (y * map_size + x) + channel)] =
                    static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * normal[channel]));
            }
        }
    }
    return map;
}

/// Colors that vary with the height.
Image color_map() {
    Image map = make_image(map_size, map_size, 3, 8, ColorSpace::srgb);
    const std::span<std::uint8_t> samples = map.as<std::uint8_t>();
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<std::uint8_t>(80 + i / 3 / map_size * 2 + 20 * (i % 3));
    return map;
}

/// A sphere with a normal map and colors.
Scene wavy_sphere(const Image& normals, const Image& colors, Mesh mesh = test::sphere(48, 24)) {
    Material material;
    MetallicRoughness& model = material.metallic_roughness.emplace();
    model.base_color = glm::vec3(0.8F);
    model.metallic = 0.0F;
    model.roughness = 0.6F;
    material.diffuse_texture = Texture{.image = 0};
    material.normal_map = NormalMap{.texture = {.image = 1}, .flat = FlatCode::half};
    Scene scene = test::scene_of(std::move(mesh), material);
    scene.images = {{"colors", Shared<Image>(colors)}, {"normals", Shared<Image>(normals)}};
    return scene;
}

Scene wavy_sphere() {
    return wavy_sphere(wave_map(), color_map());
}

/// Calls change(x, y, samples) for every texel.
template <typename Change>
Image changed(Image map, const Change& change) {
    const Image before = map;
    const std::span<const std::uint8_t> from = before.as<std::uint8_t>();
    const std::span<std::uint8_t> to = map.as<std::uint8_t>();
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x)
            change(x, y, from, &to[static_cast<std::size_t>(3 * (y * map.width + x))]);
    }
    return map;
}

struct Fault {
    const char* name;
    std::function<Scene()> make;
    /// The figure that it raises, and that figure's floor.
    std::function<std::pair<double, double>(const Fidelity&)> figure;
};

std::pair<double, double> mean_degrees(const Fidelity& f) {
    return {f.normals.mean, f.normals.floor};
}

std::vector<Fault> faults() {
    using Samples = std::span<const std::uint8_t>;
    const auto black = [](std::uint8_t* to) { std::fill(to, to + 3, std::uint8_t{0}); };
    return {
        {"inverted green",
         [] {
             Scene scene = wavy_sphere();
             scene.materials[0].normal_map->green = Green::down;
             return scene;
         },
         mean_degrees},
        {"map shifted by a texel",
         [] {
             return wavy_sphere(
                 changed(wave_map(),
                         [](int x, int y, Samples from, std::uint8_t* to) {
                             const int left = (x + map_size - 1) % map_size;
                             const auto at = static_cast<std::ptrdiff_t>(3 * (y * map_size + left));
                             std::copy_n(from.begin() + at, 3, to);
                         }),
                 color_map());
         },
         mean_degrees},
        {"mirrored charts",
         [] {
             Mesh mesh = test::with_tangents(test::sphere(48, 24));
             for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
                 if (mesh.positions[i].x > 0.0F) mesh.tangents[i].w *= -1.0F;
             }
             return wavy_sphere(wave_map(), color_map(), std::move(mesh));
         },
         mean_degrees},
        {"map of an eighth of the size",
         [] { return wavy_sphere(mip_levels(wave_map())[2], color_map()); }, mean_degrees},
        {"missing side",
         [] {
             Mesh mesh = test::sphere(48, 24);
             std::erase_if(mesh.triangles, [&](const glm::uvec3& triangle) {
                 return mesh.positions[triangle.x].x > 0.5F;
             });
             return wavy_sphere(wave_map(), color_map(), std::move(mesh));
         },
         [](const Fidelity& f) { return std::pair(f.silhouettes.width, f.silhouettes.floor); }},
        {"texels without color",
         [=] {
             return wavy_sphere(wave_map(),
                                changed(color_map(), [=](int x, int y, Samples, std::uint8_t* to) {
                                    if (x >= 16 && x < 24 && y >= 24 && y < 40) black(to);
                                }));
         },
         [](const Fidelity& f) {
             return std::pair(f.pictures[base_color].worst.value, f.pictures[base_color].floor);
         }},
        {"texels without a normal",
         [=] {
             return wavy_sphere(changed(wave_map(),
                                        [=](int x, int y, Samples, std::uint8_t* to) {
                                            if (x >= 16 && x < 24 && y >= 24 && y < 40) black(to);
                                        }),
                                color_map());
         },
         [](const Fidelity& f) { return std::pair(f.normals.worst.value, f.normals.floor); }},
        {"broken seam",
         [=] {
             return wavy_sphere(changed(wave_map(),
                                        [=](int x, int, Samples, std::uint8_t* to) {
                                            if (x == 0 || x == map_size - 1) black(to);
                                        }),
                                color_map());
         },
         [](const Fidelity& f) { return std::pair(f.normals.worst.value, f.normals.floor); }},
    };
}

TEST_F(FidelityTest, OfEqualScenesIsPerfect) {
    const Scene scene = wavy_sphere();
    Report report;
    FidelityMeter meter(context(), scene, small_pictures);
    const Fidelity fidelity = meter.measure(scene, report);
    for (const PictureLoss& loss : fidelity.pictures) {
        EXPECT_EQ(loss.mean, 0.0);
        EXPECT_EQ(loss.p95, 0.0);
        EXPECT_EQ(loss.worst.value, 0.0);
        EXPECT_GT(loss.floor, 0.0);
        EXPECT_LT(loss.floor, 0.05);
    }
    EXPECT_EQ(fidelity.normals.mean, 0.0);
    EXPECT_EQ(fidelity.normals.max, 0.0);
    EXPECT_GT(fidelity.normals.pixels, 5000U);
    EXPECT_EQ(fidelity.silhouettes.width, 0.0);
    EXPECT_EQ(fidelity.studio_mean_on_black, 0.0);
    EXPECT_EQ(fidelity.max_picture_mean(), 0.0);
    EXPECT_EQ(fidelity.views.size(), small_pictures.views);
    for (const Finding& finding : report.findings())
        EXPECT_NE(finding.element, "picture") << finding.kind;
    EXPECT_NEAR(fidelity.diameter, 2.0, 1e-6);
    EXPECT_NEAR(fidelity.pixels_across, 57.6, 1e-9);
}

TEST_F(FidelityTest, IsReducedByPlantedFaults) {
    FidelityMeter meter(context(), wavy_sphere(), small_pictures);
    for (const Fault& fault : faults()) {
        const auto [value, floor] = fault.figure(meter.measure(fault.make()));
        EXPECT_GT(value, 3.0 * floor) << fault.name;
        RecordProperty(fault.name, std::to_string(value) + " floor " + std::to_string(floor));
    }
}

}  // namespace
}  // namespace relief
