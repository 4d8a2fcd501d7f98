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

const FidelityOptions small_pictures{.size = 64, .samples = 4, .views = 6};
constexpr int map_size = 64;
constexpr auto studio = static_cast<std::size_t>(FidelityLight::studio);
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
    ASSERT_EQ(fidelity.views.size(), small_pictures.views);
    EXPECT_EQ(fidelity.views[3].from, fidelity_view(3));
    for (const Finding& finding : report.findings())
        EXPECT_NE(finding.element, "view") << finding.kind;
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

/// The figures of two measurements are the same bits.
void expect_equal(const Fidelity& a, const Fidelity& b) {
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        EXPECT_EQ(a.pictures[i].mean, b.pictures[i].mean);
        EXPECT_EQ(a.pictures[i].p95, b.pictures[i].p95);
        EXPECT_EQ(a.pictures[i].floor, b.pictures[i].floor);
        EXPECT_TRUE(test::same_bits(a.pictures[i].difference, b.pictures[i].difference));
    }
    EXPECT_EQ(a.normals.mean, b.normals.mean);
    EXPECT_EQ(a.normals.max, b.normals.max);
    EXPECT_EQ(a.silhouettes.width, b.silhouettes.width);
}

/// A sphere without maps.
Scene plain_sphere(Mesh mesh = test::sphere(16, 8)) {
    return test::scene_of(std::move(mesh), Material());
}

const FidelityOptions tiny_pictures{.size = 32, .samples = 4, .views = 2};

TEST_F(FidelityTest, DependsNeitherOnTheOrderOfTrianglesNorOnThreads) {
    const Scene coarse = plain_sphere(test::sphere(8, 6));
    FidelityMeter meter(context(), plain_sphere(), tiny_pictures);
    const Fidelity expected = meter.measure(coarse);
    EXPECT_GT(expected.normals.mean, 3.0 * expected.normals.floor);
    EXPECT_GT(expected.silhouettes.width, expected.silhouettes.floor);
    Mesh reversed = test::sphere(8, 6);
    std::reverse(reversed.triangles.begin(), reversed.triangles.end());
    expect_equal(meter.measure(plain_sphere(reversed)), expected);
    set_thread_limit(1);
    expect_equal(meter.measure(coarse), expected);
    set_thread_limit(0);
}

TEST_F(FidelityTest, DoesNotDependOnTheUnit) {
    const auto scaled = [](Mesh mesh, float scale) {
        for (glm::vec3& position : mesh.positions)
            position *= scale;
        return plain_sphere(std::move(mesh));
    };
    std::vector<Fidelity> measured;
    for (const float scale : {1.0F, std::ldexp(1.0F, -20), std::ldexp(1.0F, 20)}) {
        FidelityMeter meter(context(), scaled(test::sphere(16, 8), scale), tiny_pictures);
        measured.push_back(meter.measure(scaled(test::sphere(8, 6), scale)));
        EXPECT_NEAR(measured.back().diameter / static_cast<double>(scale), 2.0, 1e-5);
    }
    expect_equal(measured[1], measured[0]);
    expect_equal(measured[2], measured[0]);
}

TEST_F(FidelityTest, MeasuresMoreViewsOnRequest) {
    // A hole at the upper pole, and views along the axis that points up.
    Mesh open = test::sphere(16, 16);
    std::erase_if(open.triangles,
                  [&](const glm::uvec3& triangle) { return open.positions[triangle.x].y > 0.9F; });
    FidelityOptions pictures{.size = 32, .samples = 4, .views = 1};
    pictures.more_views = {{0.0F, 3.0F, 0.0F}, {0.0F, -3.0F, 0.0F}};
    FidelityMeter meter(context(), plain_sphere(test::sphere(16, 16)), pictures);
    const Fidelity fidelity = meter.measure(plain_sphere(open));
    ASSERT_EQ(fidelity.views.size(), 3U);
    EXPECT_EQ(fidelity.views[1].from, glm::vec3(0.0F, 1.0F, 0.0F));
    EXPECT_GT(fidelity.views[1].flip[studio], 0.05);
    EXPECT_EQ(fidelity.views[2].flip[studio], 0.0);
    EXPECT_EQ(fidelity.pictures[studio].worst.view, 1U);
}

TEST_F(FidelityTest, SamplesTheViewsOfTheFloor) {
    const Scene coarse = plain_sphere(test::sphere(8, 6));
    FidelityOptions pictures = tiny_pictures;
    pictures.views = 5;
    FidelityMeter meter(context(), plain_sphere(), pictures);
    const Fidelity fidelity = meter.measure(coarse);
    const SampledFidelity sampled = meter.measure_sampled(coarse);
    EXPECT_EQ(sampled.flip, fidelity.sampled.flip);
    EXPECT_EQ(sampled.normals.p99, fidelity.sampled.normals.p99);
    EXPECT_EQ(sampled.silhouette_pixels, fidelity.sampled.silhouette_pixels);
    EXPECT_LT(sampled.normals.pixels, fidelity.normals.pixels / 2);
    // The means of two views are between those of each.
    const auto [low, high] = std::minmax(fidelity.views[0].degrees, fidelity.views[4].degrees);
    EXPECT_GE(sampled.normals.mean, low);
    EXPECT_LE(sampled.normals.mean, high);
    EXPECT_EQ(meter.measure_sampled(plain_sphere()).flip[studio], 0.0);
}

TEST_F(FidelityTest, CountsAMissingResult) {
    FidelityMeter meter(context(), plain_sphere(), tiny_pictures);
    for (const Scene& nothing : {Scene(), plain_sphere(Mesh())}) {
        Report report;
        const Fidelity fidelity = meter.measure(nothing, report);
        // The area of a disc is half of its radius times its circumference.
        EXPECT_NEAR(fidelity.silhouettes.width, fidelity.pixels_across / 4.0, 1.0);
        EXPECT_GT(fidelity.pictures[studio].mean, 0.1);
        EXPECT_EQ(fidelity.normals.pixels, 0U);
        EXPECT_EQ(report.count("picture without a pixel that both models cover"),
                  tiny_pictures.views);
    }
}

TEST_F(FidelityTest, ComparesScenesOfSeveralPartsAndMeshesWithoutNormals) {
    Scene parts = plain_sphere();
    parts.instances[0].world_from_object[3] = glm::vec4(-1.5F, 0.0F, 0.0F, 1.0F);
    parts.instances.push_back(parts.instances[0]);
    parts.instances[1].world_from_object[3] = glm::vec4(1.5F, 0.0F, 0.0F, 1.0F);
    Scene joined = plain_sphere(world_surface(parts));
    ASSERT_EQ(joined.meshes[0]->triangles.size(), 2 * parts.meshes[0]->triangles.size());
    FidelityMeter meter(context(), parts, tiny_pictures);
    const Fidelity fidelity = meter.measure(joined);
    // Rounded positions may move a sample across an edge. Normals are computed for the joined mesh.
    EXPECT_LT(fidelity.silhouettes.width, 0.01);
    EXPECT_LT(fidelity.normals.mean, 20.0);
    Scene half = parts;
    half.instances.pop_back();
    EXPECT_GT(meter.measure(half).silhouettes.width, 1.0);
}

TEST_F(FidelityTest, DrawsSourcesWithoutMaterialsMatte) {
    Material shiny;
    shiny.metallic_roughness.emplace();
    const Scene source = plain_sphere(test::sphere(16, 8));
    Scene plain = source;
    plain.materials[0] = default_material();
    Scene metal = source;
    metal.materials[0] = shiny;
    {
        Report report;
        FidelityMeter meter(context(), plain, tiny_pictures, report);
        EXPECT_EQ(report.count("source without materials"), 1U);
        EXPECT_EQ(meter.measure(metal).max_picture_mean(), 0.0);
    }
    Report report;
    FidelityMeter meter(context(), metal, tiny_pictures, report);
    EXPECT_EQ(report.count("source without materials"), 0U);
    EXPECT_GT(meter.measure(plain).max_picture_mean(), 0.05);
}

TEST_F(FidelityTest, DerivesTheSamePictureOfOneColorThatIsDrawn) {
    const Scene derived = plain_sphere();
    Scene drawn = derived;
    drawn.materials[0].alpha_mode = AlphaMode::mask;
    FidelityMeter meter(context(), derived, tiny_pictures);
    const Fidelity fidelity = meter.measure(drawn);
    // Colors of 16 bits may differ by rounding.
    EXPECT_LT(fidelity.pictures[base_color].mean, 1e-3);
    EXPECT_EQ(fidelity.silhouettes.width, 0.0);
}

TEST_F(FidelityTest, ReportsResultsThatReachTheEdge) {
    FidelityMeter meter(context(), plain_sphere(), tiny_pictures);
    Scene large = plain_sphere();
    large.instances[0].world_from_object = glm::mat4(2.0F);
    large.instances[0].world_from_object[3] = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    Report report;
    const Fidelity fidelity = meter.measure(large, report);
    EXPECT_EQ(report.count("result that reaches the edge of the picture"), tiny_pictures.views);
    EXPECT_GT(fidelity.silhouettes.width, 1.0);
}

TEST_F(FidelityTest, RefusesSourcesAndOptionsOutOfRange) {
    EXPECT_THROW(FidelityMeter(context(), Scene(), tiny_pictures), InvalidInput);
    EXPECT_THROW(FidelityMeter(context(), plain_sphere(test::mesh_from({{1, 1, 1}}, {{0, 0, 0}}))),
                 InvalidInput);
    for (const FidelityOptions& wrong : {FidelityOptions{.size = 8}, FidelityOptions{.samples = 2},
                                         FidelityOptions{.views = 0}, FidelityOptions{.views = 13}})
        EXPECT_THROW(FidelityMeter(context(), plain_sphere(), wrong), InvalidInput);
    FidelityOptions no_direction = tiny_pictures;
    no_direction.more_views = {glm::vec3(0.0F)};
    EXPECT_THROW(FidelityMeter(context(), plain_sphere(), no_direction), InvalidInput);
}

TEST(FidelityMargin, IsTheRadiusOfTheFilters) {
    constexpr int size = 2 * fidelity_margin + 5;
    constexpr int middle = size / 2;
    Image one = make_image(size, size, 3, 32, ColorSpace::linear);
    const std::span<float> samples = one.as<float>();
    std::fill(samples.begin(), samples.end(), 0.2F);
    const Image before = one;
    // Blue, whose filter is the widest.
    samples[static_cast<std::size_t>(3 * (middle * size + middle) + 2)] = 1.0F;
    const Image map = flip_difference(before, one).map;
    const std::span<const float> row =
        map.as<float>().subspan(static_cast<std::size_t>(middle * size));
    EXPECT_GT(row[middle + fidelity_margin], 0.0F);
    EXPECT_EQ(row[middle + fidelity_margin + 1], 0.0F);
}

TEST(FidelityViews, AreOppositePairsOfUnitVectors) {
    for (std::size_t view = 0; view < fidelity_view_count; ++view) {
        const glm::vec3 from = fidelity_view(view);
        EXPECT_NEAR(glm::length(from), 1.0F, 1e-6F);
        EXPECT_EQ(from, -fidelity_view(view ^ 1U));
        // The angle between neighbors of an icosahedron.
        float nearest = -1.0F;
        for (std::size_t other = 0; other < fidelity_view_count; ++other) {
            if (other != view) nearest = std::max(nearest, glm::dot(from, fidelity_view(other)));
        }
        EXPECT_NEAR(nearest, std::sqrt(0.2F), 1e-5F);
    }
}

}  // namespace
}  // namespace relief
