// SPDX-License-Identifier: Apache-2.0
// The layers of a bake (heights, occlusion, curvature, positions, colors) against reference
// values; no layer changes another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <span>

#include "bake/layers.h"
#include "mesh/bake/bake_support.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/sanitized.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::bake;
using test::BakedImage;
using test::moved;
using test::sized;

BakeOptions all_layers(int width, int height) {
    BakeOptions options = sized(width, height);
    options.map.layers.occlusion = OcclusionOptions{.rays = 8, .distance = {}};
    options.map.layers.curvature = true;
    options.map.layers.positions = true;
    options.map.layers.colors = true;
    options.map.layers.opacity = true;
    options.map.layers.bent_normals = options.map.layers.occlusion;
    options.map.layers.thickness = ThicknessOptions{.rays = 8, .distance = {}};
    options.map.layers.ids = true;
    return options;
}

/// A torus with colors that depend on the position.
Mesh colored_torus() {
    Mesh mesh = make_torus(0.45F, 120, 60);
    for (const glm::vec3& position : mesh.positions)
        mesh.colors.emplace_back(0.5F + 0.3F * position, 0.5F);
    return mesh;
}

TEST(BakeLayers, HaveNoSayInEachOther) {
    const Mesh high = colored_torus();
    const Mesh low = make_torus();
    for (const auto& [samples, angle] :
         {std::pair<int, std::optional<double>>(1, {}), {16, {}}, {16, 0.02}}) {
        if (test::is_sanitized && !angle) continue;
        // Clang 14 captures structured bindings only by name.
        const auto with = [&, samples = samples, angle = angle](BakeOptions options) {
            options.map.samples = samples;
            options.map.sample_angle = angle;
            options.map.padding = 3;
            return bake({high}, low, options);
        };
        const BakedImage all = with(all_layers(70, 50));
        const auto only = [&](const auto& choose) {
            BakeOptions options = sized(70, 50);
            options.map.layers = {};
            options.map.layers.normals = false;
            choose(options.map.layers);
            return with(options);
        };
        const BakedImage normals = only([](BakeLayers& layers) { layers.normals = true; });
        EXPECT_EQ(normals.normals, all.normals);
        EXPECT_EQ(normals.states, all.states);
        EXPECT_TRUE(normals.heights.empty() && normals.occlusion.empty());
        EXPECT_TRUE(normals.curvature.empty() && normals.positions.empty());
        EXPECT_TRUE(normals.colors.empty() && normals.bent_normals.empty());
        EXPECT_TRUE(normals.thickness.empty() && normals.ids.empty());
        EXPECT_EQ(normals.result.rays, all.result.rays);
        EXPECT_EQ(normals.result.occlusion_rays, 0U);
        EXPECT_EQ(normals.result.thickness_rays, 0U);
        const BakedImage heights = only([](BakeLayers& layers) { layers.heights = true; });
        EXPECT_EQ(heights.heights, all.heights);
        EXPECT_TRUE(heights.normals.empty());
        EXPECT_EQ(only([](BakeLayers& layers) {
                      layers.occlusion = {8, {}};
                  }).occlusion,
                  all.occlusion);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.curvature = true; }).curvature,
                  all.curvature);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.positions = true; }).positions,
                  all.positions);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.colors = true; }).colors, all.colors);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.opacity = true; }).opacity, all.opacity);
        EXPECT_EQ(only([](BakeLayers& layers) {
                      layers.bent_normals = {8, {}};
                  }).bent_normals,
                  all.bent_normals);
        EXPECT_EQ(only([](BakeLayers& layers) {
                      layers.thickness = {8, {}};
                  }).thickness,
                  all.thickness);
        EXPECT_EQ(only([](BakeLayers& layers) { layers.ids = true; }).ids, all.ids);
        set_thread_limit(1);
        const BakedImage alone = with(all_layers(70, 50));
        set_thread_limit(0);
        EXPECT_EQ(alone.occlusion, all.occlusion);
        EXPECT_EQ(alone.curvature, all.curvature);
        EXPECT_EQ(alone.positions, all.positions);
        EXPECT_EQ(alone.colors, all.colors);
        EXPECT_EQ(alone.bent_normals, all.bent_normals);
        EXPECT_EQ(alone.thickness, all.thickness);
        EXPECT_EQ(alone.ids, all.ids);
    }
}

TEST(BakeLayers, PositionsAreHitsInTheRequestedAxes) {
    BakeOptions options = sized(8, 4);
    options.map.layers.positions = true;
    options.map.layers.position_from_mesh =
        glm::translate(glm::dmat4(1.0), {10.0, 20.0, 30.0}) * glm::dmat4(glm::dmat3(2.0));
    const BakedImage image = bake({moved(make_quad(), 1.0F, {0, 0, 0.25F})}, make_quad(), options);
    for (std::size_t i = 0; i < 32; ++i) {
        const double x = (static_cast<double>(i % 8) + 0.5) / 4.0 - 1.0;
        const double y = 1.0 - (static_cast<double>(i / 8) + 0.5) / 2.0;
        EXPECT_NEAR(image.positions[3 * i], 10.0 + 2.0 * x, 1e-5);
        EXPECT_NEAR(image.positions[3 * i + 1], 20.0 + 2.0 * y, 1e-5);
        EXPECT_NEAR(image.positions[3 * i + 2], 30.5, 1e-5);
    }
}

TEST(BakeLayers, CurvatureIsThatOfTheHighMesh) {
    BakeOptions options = sized(64, 32);
    options.map.layers.curvature = true;
    const Mesh high = moved(make_sphere(256, 128), 2.5F, glm::vec3(0));
    const Mesh low = moved(make_sphere(32, 16), 2.5F, glm::vec3(0));
    for (const float here : bake({high}, low, options).curvature)
        EXPECT_NEAR(here, 0.4, 0.001);
    // From the inside, the same surface is concave.
    Mesh turned = high;
    for (glm::uvec3& triangle : turned.triangles)
        std::swap(triangle.y, triangle.z);
    options.back_faces = BackFaces::take;
    for (const float here : bake({turned}, low, options).curvature)
        EXPECT_NEAR(here, 0.4, 0.001);
}

TEST(BakeLayers, OcclusionIsThatOfTheHighMeshes) {
    // A floor, and a roof 0.5 above it, below which rays begin. At its rim, half of the sky is
    // visible; far below it, almost nothing.
    Mesh roof = moved(make_quad(), 8.0F, {8.0F, 0, 0.5F});
    BakeOptions options = sized(33, 1);
    options.map.layers.occlusion = OcclusionOptions{.rays = 1024, .distance = 100.0};
    options.offset = 0.25;
    options.max_distance = 0.25;
    options.allow_size_mismatch = true;
    const BakedImage image =
        bake({moved(make_quad(), 8.0F, glm::vec3(0)), roof}, make_quad(), options);
    EXPECT_EQ(image.result.occlusion_rays, 33U * 1024U);
    for (std::size_t i = 0; i < 33; ++i) {
        const double x = (static_cast<double>(i) + 0.5) / 16.5 - 1.0;
        // An infinite half plane: half of 1 minus the sine of the angle between its rim and the
        // vertical.
        const double reference = 0.5 * (1.0 - x / std::hypot(x, 0.5));
        EXPECT_NEAR(image.occlusion[i], reference, 0.01) << x;
    }
}

TEST(BakeLayers, MissedTexelsAreBackgroundOrPadding) {
    Mesh high = moved(make_quad(), 1.0F, {0, 0, 0.25F});
    for (glm::vec3& position : high.positions)
        position.x = (position.x - 1.0F) / 2.0F;
    high.colors.assign(4, {0.25F, 0.5F, 0.75F, 1.0F});
    BakeOptions options = all_layers(16, 4);
    options.map.padding = 2;
    const BakedImage image = bake({high}, make_quad(), options);
    for (const std::size_t i : {7UL, 9UL}) {
        EXPECT_EQ(image.occlusion[i], 1.0F);
        EXPECT_EQ(image.colors[3 * i + 1], 0.5F);
        EXPECT_NEAR(image.positions[3 * i], -0.0625F, 1e-6F);
    }
    EXPECT_EQ(image.states[10], TexelState::missed);
    EXPECT_EQ(image.occlusion[10], 1.0F);
    EXPECT_EQ(image.colors[31], 0.0F);
    EXPECT_EQ(image.positions[30], 0.0F);
}

TEST(BakeLayers, ColorsOfVerticesAreMixedInLight) {
    Mesh high = make_quad();
    for (const glm::vec3& position : high.positions)
        high.colors.emplace_back(0.5F + 0.5F * position.x, 0.25F, 0.0F, 0.5F);
    Mesh bare = moved(make_quad(), 1.0F, {2.0F, 0, 0});
    Mesh low = make_quad();
    for (glm::vec3& position : low.positions)
        position.x = 1.0F + 2.0F * position.x;
    BakeOptions options = sized(16, 1);
    options.map.layers.colors = true;
    options.map.samples = 4;
    const BakedImage image = bake({high, bare}, low, options);
    for (std::size_t i = 0; i < 16; ++i) {
        const double red = i < 8 ? (static_cast<double>(i) + 0.5) / 8.0 : 1.0;
        EXPECT_NEAR(image.colors[3 * i], red, 1e-6);
        EXPECT_NEAR(image.colors[3 * i + 1], i < 8 ? 0.25 : 1.0, 1e-6);
    }
    EXPECT_EQ(image.report.count("high mesh without colors"), 1U);
    EXPECT_EQ(image.report.findings()[0].first, (std::vector<std::size_t>{1}));
}

TEST(BakeLayers, RefusesInvalidOptions) {
    BakeOptions options = sized(4, 4);
    options.map.layers.occlusion = OcclusionOptions{.rays = 0, .distance = {}};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "the number of occlusion rays is 0, but must be within [1, 65536]");
    options.map.layers.occlusion = OcclusionOptions{.rays = 4, .distance = -1.0};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "the distance of occlusion is -1, but must be finite and at least 0");
    options.map.layers.occlusion.reset();
    options.map.layers.bent_normals = OcclusionOptions{.rays = 65537, .distance = {}};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "the number of bent normal rays is 65537, but must be within [1, 65536]");
    options.map.layers.bent_normals = OcclusionOptions{.rays = 8, .distance = {}};
    options.map.layers.occlusion = OcclusionOptions{.rays = 4, .distance = {}};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "occlusion and bent normals have different rays, which they share");
    options.map.layers = {.thickness = ThicknessOptions{.rays = 4, .distance = -2.0}};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { bake({make_quad()}, make_quad(), options); }),
              "the distance of thickness is -2, but must be finite and at least 0");
}

TEST(BakeLayers, OfAMapMustBeThoseOfItsBaker) {
    const std::vector<Mesh> high = {make_quad()};
    BakeOptions options = sized(4, 4);
    Report report;
    const Baker baker(high, make_quad(), options, report);
    BakeMapOptions map = options.map;
    map.layers = {.normals = false, .positions = true};
    std::size_t rows = 0;
    baker.bake(
        map,
        [&](const BakedRows& baked) {
            EXPECT_EQ(baked.positions.size(), 48U);
            EXPECT_TRUE(baked.normals.empty() && baked.heights.empty());
            ++rows;
        },
        report);
    EXPECT_EQ(rows, 1U);
    const BakeMapOptions prepared = map;
    for (const auto& add : {+[](BakeLayers& layers) { layers.curvature = true; },
                            +[](BakeLayers& layers) { layers.bent_normals.emplace(); },
                            +[](BakeLayers& layers) { layers.ids = true; }}) {
        map = prepared;
        add(map.layers);
        EXPECT_EQ(test::message_of<InvalidInput>([&] {
                      baker.bake(
                          map, [](const auto&) {}, report);
                  }),
                  "a map requests a layer that its Baker does not have");
    }
}

RayMesh ray_mesh(const Mesh& mesh) {
    return {mesh.positions, mesh.triangles};
}

/// A disc of radius 1 that faces the z axis, with this number of sides. Its area is that of the
/// circle.
Mesh disc(float height, double aside = 0.0, int sides = 512) {
    const double angle = 2.0 * std::numbers::pi / sides;
    const double radius = std::sqrt(angle / std::sin(angle));
    Mesh mesh;
    mesh.positions.emplace_back(aside, 0, height);
    for (int i = 0; i < sides; ++i) {
        mesh.positions.emplace_back(aside + radius * std::cos(i * angle),
                                    radius * std::sin(i * angle), height);
        const auto here = static_cast<std::uint32_t>(i);
        mesh.triangles.emplace_back(0, here + 1,
                                    (here + 1) % static_cast<std::uint32_t>(sides) + 1);
    }
    return mesh;
}

/// The same point for several texels of a map, each with its own ray directions.
std::vector<OcclusionPlace> from_origin(std::size_t texels, std::uint32_t samples = 1) {
    std::vector<OcclusionPlace> places;
    for (std::size_t texel = 0; texel < texels; ++texel) {
        for (std::uint32_t sample = 0; sample < samples; ++sample)
            places.push_back({glm::dvec3(0), {0, 0, 1}, {0, 0, 1}, texel, sample});
    }
    return places;
}

struct OcclusionError {
    double root_mean_square = 0.0;
    double mean = 0.0;
};

OcclusionError error_of(const std::vector<double>& shares, double reference) {
    OcclusionError error;
    for (const double share : shares) {
        error.mean += (share - reference) / static_cast<double>(shares.size());
        error.root_mean_square +=
            (share - reference) * (share - reference) / static_cast<double>(shares.size());
    }
    error.root_mean_square = std::sqrt(error.root_mean_square);
    return error;
}

OcclusionOptions rays(int count, double distance = 10.0) {
    return {.rays = count, .distance = distance};
}

/// Returns the unoccluded share at the origin: the closed-form configuration factor of a disc
/// parallel to an element.
double open_beside(double height, double aside) {
    const double away = height * height + aside * aside;
    const double z = 1.0 + away;
    return 1.0 - 0.5 * (1.0 - (away - 1.0) / std::sqrt(z * z - 4.0 * aside * aside));
}

TEST(Occlusion, UnderADiscIsItsClosedForm) {
    Report report;
    EXPECT_DOUBLE_EQ(open_beside(2.0, 0.0), 0.8);
    for (const auto& [height, aside] : {std::pair(0.5F, 0.0), {1.0F, 0.3}, {2.0F, 1.5}}) {
        const Mesh mesh = disc(height, aside);
        const RayScene scene({ray_mesh(mesh)});
        const double reference = open_beside(double{height}, aside);
        const auto shares = Occlusion(rays(256), 1).open_shares(scene, from_origin(500), report);
        EXPECT_LT(error_of(shares, reference).root_mean_square, 0.009) << height;
        EXPECT_NEAR(error_of(shares, reference).mean, 0.0, 0.001) << height;
        // Surfaces beyond the length of the rays occlude nothing.
        const auto near =
            Occlusion(rays(64, 0.9 * height), 1).open_shares(scene, from_origin(10), report);
        EXPECT_EQ(error_of(near, 1.0).root_mean_square, 0.0);
    }
    EXPECT_TRUE(report.empty());
}

TEST(Occlusion, ErrorFallsFasterThanThatOfRaysAtRandom) {
    const Mesh mesh = disc(0.8F, 0.6);
    const RayScene scene({ray_mesh(mesh)});
    const double reference = open_beside(0.8F, 0.6);
    Report report;
    double before = 0.0;
    for (const int count : {4, 64, 1024}) {
        const auto shares = Occlusion(rays(count), 1).open_shares(scene, from_origin(1000), report);
        const double error = error_of(shares, reference).root_mean_square;
        // Random directions have an error of about 0.5 / sqrt(count), which decreases by 4 for 16
        // times as many. Here it decreases by 8, for rays at a border in the disc of directions.
        EXPECT_LT(error, 0.5 / std::sqrt(count));
        if (before > 0.0) {
            EXPECT_LT(error, 0.16 * before) << count;
        }
        before = error;
    }
    EXPECT_LT(before, 0.003);
}

TEST(Occlusion, SamplesDivideTheRaysOfATexel) {
    const Mesh mesh = disc(1.0F);
    const RayScene scene({ray_mesh(mesh)});
    Report report;
    const Occlusion shared(rays(256), 16);
    EXPECT_EQ(shared.rays_of_sample(), 16U);
    EXPECT_EQ(Occlusion(rays(20), 16).rays_of_sample(), 2U);
    const auto shares = shared.open_shares(scene, from_origin(500, 16), report);
    std::vector<double> means;
    for (std::size_t texel = 0; texel < 500; ++texel) {
        double sum = 0.0;
        for (std::size_t sample = 0; sample < 16; ++sample)
            sum += shares[16 * texel + sample] / 16.0;
        means.push_back(sum);
    }
    // The result is as accurate as that of one sample with all rays.
    EXPECT_LT(error_of(means, 0.5).root_mean_square, 0.009);
}

TEST_LABELS(not_sanitized);
TEST(Occlusion, InABowlIsTheOpenFractionOfTheSphere) {
    // The inner side of a sphere, cut off above y = 0 and above y = 0.5.
    for (const int kept : {32, 48}) {
        constexpr int stacks = 64;
        Mesh mesh = make_sphere(128, stacks);
        std::erase_if(mesh.triangles, [&](const glm::uvec3& triangle) {
            const float height = mesh.positions[triangle.x].y + mesh.positions[triangle.y].y +
                                 mesh.positions[triangle.z].y;
            return height > 3.0F * std::cos(std::numbers::pi_v<float> *
                                            static_cast<float>(stacks - kept) / stacks);
        });
        const RayScene scene({ray_mesh(mesh)});
        std::vector<OcclusionPlace> places;
        for (std::size_t i = 0; i < mesh.triangles.size(); i += 5) {
            const auto corners = scene.corners(0, static_cast<std::uint32_t>(i));
            const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            if (glm::length(cross) < 1e-9) continue;
            places.push_back({middle, -glm::normalize(middle), -glm::normalize(cross), i, 0});
        }
        Report report;
        const double open = 0.5 * (1.0 - std::cos(std::numbers::pi * (stacks - kept) / stacks));
        const auto shares = Occlusion(rays(256), 1).open_shares(scene, places, report);
        EXPECT_LT(error_of(shares, open).root_mean_square, 0.02) << kept;
        EXPECT_NEAR(error_of(shares, open).mean, 0.0, 0.003) << kept;
    }
}

TEST(Occlusion, NothingHidesItself) {
    // A coarse sphere whose smooth normals differ by up to 20 degrees from its face normals, and
    // the same square twice.
    Report report;
    const Mesh sphere = make_sphere(12, 8);
    const RayScene round({ray_mesh(sphere)});
    std::vector<OcclusionPlace> places;
    for (std::size_t i = 0; i < sphere.triangles.size(); ++i) {
        const auto corners = round.corners(0, static_cast<std::uint32_t>(i));
        const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(cross) < 1e-9) continue;
        for (const glm::dvec3& weights :
             {glm::dvec3(0.98, 0.01, 0.01), glm::dvec3(0.3, 0.3, 0.4), glm::dvec3(0, 0.5, 0.5)}) {
            const glm::dvec3 point =
                weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
            places.push_back({point, glm::normalize(point), glm::normalize(cross), i, 0});
        }
    }
    for (const double share : Occlusion(rays(64), 1).open_shares(round, places, report))
        EXPECT_EQ(share, 1.0);
    const Mesh square = make_quad(3);
    const RayScene twice({ray_mesh(square), ray_mesh(square)});
    for (const double share : Occlusion(rays(64), 1).open_shares(twice, from_origin(50), report))
        EXPECT_EQ(share, 1.0);
    EXPECT_TRUE(report.empty());
}

TEST(Occlusion, UsesTheTriangleIfTheNormalIsUnusable) {
    const Mesh mesh = disc(1.0F);
    const RayScene scene({ray_mesh(mesh)});
    std::vector<OcclusionPlace> places = from_origin(300);
    for (std::size_t i = 0; i < places.size(); ++i)
        places[i].normal = i % 2 == 0 ? glm::dvec3(0, 0, -1) : glm::dvec3(1, 0, 0);
    Report report;
    const auto shares = Occlusion(rays(64), 1).open_shares(scene, places, report);
    EXPECT_EQ(report.count("normal along its triangle or behind it"), 300U);
    EXPECT_NEAR(error_of(shares, 0.5).mean, 0.0, 0.01);
}

/// Returns a disc at z = height about the z axis, facing down.
Mesh disc_above(float radius, float height) {
    constexpr std::uint32_t sides = 256;
    Mesh disc;
    disc.positions.emplace_back(0.0F, 0.0F, height);
    for (std::uint32_t i = 0; i < sides; ++i) {
        const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / sides;
        disc.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
        disc.triangles.emplace_back(0, 1 + (i + 1) % sides, 1 + i);
    }
    return disc;
}

TEST(VertexOcclusion, UnderADiscIsItsFormFactor) {
    Mesh floor = make_quad();
    floor.positions[0] = glm::vec3(0.0F);
    floor.normals.assign(floor.positions.size(), glm::vec3(0.0F, 0.0F, 1.0F));
    for (const float radius : {0.2F, 1.0F, 5.0F}) {
        const std::vector<Mesh> occluders = {disc_above(radius, 0.7F)};
        const double expected = 1.0 - 1.0 / (1.0 + std::pow(0.7 / radius, 2.0));
        for (const auto& [rays, tolerance] : {std::pair(4096, 0.002), std::pair(64, 0.03)}) {
            const std::vector<std::vector<float>> shares = vertex_occlusion(
                std::span(&floor, 1), occluders, {.rays = rays, .distance = 100.0});
            EXPECT_NEAR(shares.at(0).at(0), expected, tolerance) << radius << ", " << rays;
        }
    }
}

TEST(VertexOcclusion, IsNoneOnConvexSurfacesAndCompleteInAClosedOne) {
    const std::vector<Mesh> ball = {make_sphere(40, 20)};
    std::vector<Mesh> inside = ball;
    for (glm::vec3& normal : inside[0].normals)
        normal = -normal;
    const std::vector<float> open(ball[0].positions.size(), 1.0F);
    const std::vector<float> hidden(ball[0].positions.size(), 0.0F);
    const OcclusionOptions far{.rays = 32, .distance = 10.0};
    EXPECT_EQ(vertex_occlusion(ball, ball, far).at(0), open);
    EXPECT_EQ(vertex_occlusion(inside, ball, far).at(0), hidden);
    // Rays without a length reach nothing.
    EXPECT_EQ(vertex_occlusion(inside, ball, {.rays = 32, .distance = 0.0}).at(0), open);
}

TEST(VertexOcclusion, HasTheSameBitsForAnyNumberOfThreads) {
    const std::vector<Mesh> torus = {make_torus(0.45F, 120, 60)};
    const OcclusionOptions options{.rays = 16, .distance = {}};
    const auto one = vertex_occlusion(torus, torus, options, {.threads = 1});
    EXPECT_EQ(one, vertex_occlusion(torus, torus, options, {.threads = 2}));
    EXPECT_LT(*std::min_element(one[0].begin(), one[0].end()), 0.8F);
    Mesh bare = torus[0];
    bare.normals.clear();
    const auto computed = vertex_occlusion(std::span(&bare, 1), torus, options);
    for (std::size_t i = 0; i < computed[0].size(); ++i)
        EXPECT_NEAR(computed[0][i], one[0][i], 0.13);
}

TEST(VertexOcclusion, IsDefinedForEveryVertex) {
    const std::vector<Mesh> ball = {make_sphere(12, 6)};
    Mesh broken = ball[0];
    for (glm::vec3& normal : broken.normals)
        normal = -normal;
    broken.positions[3].x = std::numeric_limits<float>::quiet_NaN();
    broken.normals[5] = glm::vec3(0.0F);
    const auto shares = vertex_occlusion(std::span(&broken, 1), ball, {.rays = 8, .distance = {}});
    EXPECT_EQ(shares[0][3], 1.0F);
    EXPECT_EQ(shares[0][5], 1.0F);
    EXPECT_TRUE(vertex_occlusion({}, ball, {}).empty());
    const auto alone = vertex_occlusion(ball, {}, {});
    EXPECT_EQ(alone[0], std::vector<float>(ball[0].positions.size(), 1.0F));
    EXPECT_THROW(vertex_occlusion(ball, ball, {.rays = 0, .distance = {}}), InvalidInput);
    EXPECT_THROW(vertex_occlusion(ball, ball, {.rays = 1, .distance = -1.0}), InvalidInput);
}

}  // namespace
}  // namespace relief
