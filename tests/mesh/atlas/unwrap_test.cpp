// SPDX-License-Identifier: Apache-2.0
// Unwrapping: charts, their borders, stretch and density, padding, tiles, and options. Hard input
// is in unwrap_hard_cases_test.cpp.
#include "relief/mesh/unwrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "atlas/charts.h"
#include "mesh/atlas/unwrap_promises.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::broken_promise;
using test::mesh_from;
using test::message_of;

double distance(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 edge = b - a;
    const double t = std::clamp(glm::dot(p - a, edge) / glm::dot(edge, edge), 0.0, 1.0);
    return glm::length(p - a - t * edge);
}

/// The smallest distance between two charts, and between charts and the border of the map, texels.
struct Distances {
    double between = std::numeric_limits<double>::infinity();
    double border = std::numeric_limits<double>::infinity();
};

Distances distances_of(const Unwrapped& unwrapped, const glm::dvec2& size) {
    Distances result;
    for (std::size_t s = 0; s < unwrapped.chart.size(); ++s) {
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 p = glm::dvec2(unwrapped.corner_texcoords[3 * s + i]) * size;
            result.border = std::min({result.border, p.x, p.y, size.x - p.x, size.y - p.y});
            for (std::size_t t = 0; t < unwrapped.chart.size(); ++t) {
                if (unwrapped.chart[s] == unwrapped.chart[t]) continue;
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto corner = [&](std::size_t j) {
                        return glm::dvec2(unwrapped.corner_texcoords[3 * t + j % 3]) * size;
                    };
                    result.between =
                        std::min(result.between, distance(p, corner(k), corner(k + 1)));
                }
            }
        }
    }
    return result;
}

TEST(Unwrap, FlattensACubeWithoutStretch) {
    const Mesh cube = test::uneven_cube();
    Report report;
    UnwrapOptions options;
    options.size = {256, 256};
    const Unwrapped unwrapped = unwrap(cube, options, report);
    EXPECT_EQ(broken_promise(unwrapped), "");
    EXPECT_TRUE(report.empty());
    EXPECT_NEAR(unwrapped.stats.area, 24.0, 1e-9);
    EXPECT_NEAR(unwrapped.stats.stretch, 1.0, 0.05);
    EXPECT_GT(unwrapped.stats.used, 0.4);
    EXPECT_NEAR(unwrapped.stats.used, 24.0 * std::pow(unwrapped.stats.texels_per_unit / 256.0, 2),
                1e-9);
    const Distances distances = distances_of(unwrapped, {256.0, 256.0});
    EXPECT_GE(distances.between, 4.0);
    EXPECT_GE(distances.border, 2.0);
}

/// A box of 1 x 2 x 3 with `count` x `count` squares on each side, whose diagonals alternate.
Mesh box(std::uint32_t count) {
    Mesh mesh;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (const bool is_upper : {false, true}) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (std::uint32_t i = 0; i < (count + 1) * (count + 1); ++i) {
                const auto step = [&](std::uint32_t k) {
                    return static_cast<float>(k) / static_cast<float>(count);
                };
                glm::vec3 position;
                position[axis] = is_upper ? 1.0F : 0.0F;
                position[(axis + 1) % 3] = step(i % (count + 1));
                position[(axis + 2) % 3] = step(i / (count + 1));
                mesh.positions.push_back(position * glm::vec3(1, 2, 3));
            }
            for (std::uint32_t i = 0; i < count * count; ++i) {
                const std::uint32_t a = first + i / count * (count + 1) + i % count;
                std::array<std::uint32_t, 4> v{a, a + 1, a + count + 2, a + count + 1};
                if (!is_upper) std::swap(v[1], v[3]);
                if (i % 2 == 1) std::rotate(v.begin(), v.begin() + 1, v.end());
                mesh.triangles.emplace_back(v[0], v[1], v[2]);
                mesh.triangles.emplace_back(v[0], v[2], v[3]);
            }
        }
    }
    return mesh;
}

TEST(Unwrap, CutsABoxAtItsEdges) {
    for (const std::uint32_t count : {1U, 2U, 3U, 8U, 40U}) {
        const Unwrapped unwrapped = unwrap(box(count));
        EXPECT_EQ(unwrapped.stats.charts, 6U) << count;
        EXPECT_NEAR(unwrapped.stats.seam_length, 24.0, 1e-5) << count << ": the twelve edges";
        EXPECT_NEAR(unwrapped.stats.stretch, 1.0, 1e-6) << count;
    }
}

// Small boxes are not smaller than the clusters that charts consist of.
TEST(Unwrap, CutsManyBoxesAtTheirEdges) {
    const Mesh one = box(1);
    Mesh many;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const auto first = static_cast<std::uint32_t>(many.positions.size());
        for (const glm::vec3& position : one.positions)
            many.positions.push_back(position + glm::vec3(2 * (i % 25), 4 * (i / 25), 0));
        for (const glm::uvec3& triangle : one.triangles)
            many.triangles.push_back(triangle + first);
    }
    Report report;
    const detail::AtlasSurface surface = detail::atlas_surface(many, {}, report);
    EXPECT_EQ(detail::divided(surface, {}).count, 6U * 500U);
    // Charts of a small share of the area are joined, also across edges.
    const Unwrapped unwrapped = unwrap(many);
    EXPECT_LE(unwrapped.stats.charts, 6U * 500U);
    EXPECT_NEAR(unwrapped.stats.stretch, 1.0, 1e-4);
}

/// A regular prism of height 2 with two caps.
Mesh prism(std::uint32_t sides) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double turn = 2.0 * std::numbers::pi * i / sides;
        for (const float height : {0.0F, 2.0F})
            mesh.positions.emplace_back(std::cos(turn), std::sin(turn), height);
    }
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {0, 0, 2}});
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = 2 * i;
        const std::uint32_t b = 2 * ((i + 1) % sides);
        mesh.triangles.insert(
            mesh.triangles.end(),
            {{a, b, b + 1}, {a, b + 1, a + 1}, {b, a, 2 * sides}, {a + 1, b + 1, 2 * sides + 1}});
    }
    return mesh;
}

// Two caps, and the wall in two halves.
TEST(Unwrap, DividesACylinderAsByHand) {
    for (const std::uint32_t sides : {6U, 12U, 32U, 100U}) {
        const Unwrapped unwrapped = unwrap(prism(sides));
        EXPECT_LE(unwrapped.stats.charts, 4U) << sides;
        EXPECT_NEAR(unwrapped.stats.stretch, 1.0, 1e-3) << sides;
        EXPECT_EQ(broken_promise(unwrapped), "");
    }
}

// The curvature of a part of the unit sphere is its area; that of a saddle is negative.
TEST(Unwrap, BoundsTheCurvatureOfCharts) {
    const auto divided = [](const Mesh& mesh, double curvature) {
        Report report;
        const detail::AtlasSurface surface = detail::atlas_surface(mesh, {}, report);
        detail::ChartLimits limits;
        limits.cone = std::numbers::pi;
        limits.spread = 2.0;
        limits.curvature = curvature;
        const detail::Segmentation segmentation = detail::divided(surface, limits);
        std::vector<double> areas(segmentation.count, 0.0);
        for (std::size_t face = 0; face < surface.areas.size(); ++face)
            areas[segmentation.chart[face]] += surface.areas[face] * surface.unit * surface.unit;
        return areas;
    };
    const Mesh sphere = make_sphere(64, 32);
    for (const double curvature : {0.5, 1.5, 2.5}) {
        const std::vector<double> areas = divided(sphere, curvature);
        EXPECT_LE(*std::max_element(areas.begin(), areas.end()), 1.1 * curvature);
        EXPECT_GE(static_cast<double>(areas.size()), 4.0 * std::numbers::pi / (1.1 * curvature));
    }
    Mesh saddle = test::flat_grid(40);
    for (glm::vec3& p : saddle.positions)
        p.z = p.x * p.y / 20.0F;
    EXPECT_EQ(divided(saddle, 10.0).size(), 1U);
    EXPECT_GT(divided(saddle, 0.5).size(), 1U);
}

// Borders between charts are as short as those of a division by hand. Jagged ones have seams of
// 7.3, 9.1 and 11.5.
TEST(Unwrap, HasStraightSeams) {
    const auto seams = [](const Mesh& mesh) { return unwrap(mesh).stats.relative_seam_length; };
    Mesh sphere = make_sphere(80, 40);
    sphere.texcoords.clear();
    EXPECT_LT(seams(sphere), 6.5);
    for (glm::vec3& p : sphere.positions)
        p *= 1.0F + 0.08F * std::sin(7.0F * p.x + 1.0F) * std::sin(6.0F * p.y + 2.0F) *
                        std::sin(8.0F * p.z + 0.5F);
    EXPECT_LT(seams(sphere), 7.0);
    EXPECT_LT(seams(make_torus(0.4F, 48, 24)), 8.0);
}

TEST(Unwrap, MapsAPlaneToOneRectangle) {
    const Unwrapped unwrapped = unwrap(test::flat_grid(20));
    EXPECT_EQ(broken_promise(unwrapped), "");
    EXPECT_EQ(unwrapped.stats.charts, 1U);
    EXPECT_NEAR(unwrapped.stats.seam_length, 80.0, 1e-9) << "its boundary";
    EXPECT_NEAR(unwrapped.stats.relative_seam_length, 4.0, 1e-9);
    EXPECT_NEAR(unwrapped.stats.stretch, 1.0, 1e-6);
    EXPECT_NEAR(unwrapped.stats.max_anisotropy, 1.0, 1e-4) << "rounding to the lattice";
    EXPECT_GT(unwrapped.stats.used, 0.97);
}

// An angle leaves half of its box unused, and its two arms nothing.
TEST(Unwrap, CutsAnAngleIntoStrips) {
    const Mesh plane = test::flat_grid(40);
    Mesh angle = plane;
    angle.triangles.clear();
    for (const glm::uvec3& triangle : plane.triangles) {
        const glm::vec3 center = (plane.positions[triangle.x] + plane.positions[triangle.y] +
                                  plane.positions[triangle.z]) /
                                 3.0F;
        if (std::min(center.x, center.y) < 12.0F) angle.triangles.push_back(triangle);
    }
    UnwrapOptions options;
    options.size = {512, 512};
    const Unwrapped unwrapped = unwrap(angle, options);
    EXPECT_EQ(broken_promise(unwrapped), "");
    EXPECT_GE(unwrapped.stats.charts, 2U);
    EXPECT_LE(unwrapped.stats.charts, 3U);
    EXPECT_NEAR(unwrapped.stats.stretch, 1.0, 1e-6);
    // The parts would have few texels.
    options.size = {32, 32};
    EXPECT_EQ(unwrap(angle, options).stats.charts, 1U);
}

// The longest triangles of the sphere are as dense as the others.
TEST(Unwrap, KeepsTheDensityOfASphere) {
    Mesh sphere = make_sphere(64, 32);
    sphere.texcoords.clear();
    const Unwrapped unwrapped = unwrap(sphere);
    EXPECT_EQ(broken_promise(unwrapped), "");
    EXPECT_LE(unwrapped.stats.charts, 16U);
    EXPECT_EQ(unwrapped.stats.small_charts, 0U);
    EXPECT_GT(unwrapped.stats.min_density, 0.9);
    EXPECT_LT(unwrapped.stats.max_density, 1.1);
    EXPECT_LT(unwrapped.stats.stretch, 1.005);
    EXPECT_LT(unwrapped.stats.max_anisotropy, 4.0);
    EXPECT_GT(unwrapped.stats.used, 0.5);
}

/// A flat square of 2 * side * side triangles with a spherical bump in each of 7 x 7 fields.
Mesh dented_plate(std::uint32_t side) {
    Mesh mesh;
    for (std::uint32_t y = 0; y <= side; ++y) {
        for (std::uint32_t x = 0; x <= side; ++x) {
            const glm::dvec2 at(7.0 * x / side, 7.0 * y / side);
            const double radius = glm::length(at - glm::floor(at) - 0.5);
            const double height = radius < 0.3 ? std::sqrt(0.0901 - radius * radius) : 0.0;
            mesh.positions.emplace_back(at.x, at.y, height);
        }
    }
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = y * (side + 1) + x;
            mesh.triangles.emplace_back(a, a + 1, a + side + 2);
            mesh.triangles.emplace_back(a, a + side + 2, a + side + 1);
        }
    }
    return mesh;
}

// Parts of charts that could not be flattened become parts of their neighbors.
TEST(Unwrap, MergesSmallCharts) {
    const Unwrapped unwrapped = unwrap(dented_plate(84));
    EXPECT_EQ(broken_promise(unwrapped), "");
    EXPECT_LE(unwrapped.stats.charts, 50U);
    EXPECT_LE(unwrapped.stats.small_charts, 2U);
    EXPECT_LT(unwrapped.stats.stretch, 1.03);
}

// The right angles of a texture must not become left ones: bakers and tangent spaces depend on it.
TEST(Unwrap, MirrorsNoChart) {
    Mesh torus = make_torus(0.4F, 48, 24);
    const FramedMesh framed = with_texcoords(torus, unwrap(torus));
    const Mesh with = test::with_tangents(framed.mesh);
    for (const glm::vec4& tangent : with.tangents)
        EXPECT_EQ(tangent.w, 1.0F);
}

TEST(Unwrap, KeepsPaddingAndBlocks) {
    const Mesh cube = test::uneven_cube();
    for (const int padding : {0, 1, 7, 24}) {
        UnwrapOptions options;
        options.size = {256, 200};
        options.padding = padding;
        const Unwrapped unwrapped = unwrap(cube, options);
        EXPECT_EQ(broken_promise(unwrapped), "") << padding;
        const Distances distances = distances_of(unwrapped, {256.0, 200.0});
        EXPECT_GE(distances.between, padding);
        EXPECT_GE(distances.border, 0.5 * padding);
    }
    for (const int height : {256, 200}) {
        UnwrapOptions options;
        options.size = {256, height};
        options.padding = 0;
        options.alignment = 16;
        const Unwrapped unwrapped = unwrap(cube, options);
        // The blocks of the corners; between them, an edge may pass through other blocks.
        std::map<std::pair<int, int>, std::set<std::uint32_t>> charts;
        for (std::size_t corner = 0; corner < unwrapped.corner_texcoords.size(); ++corner) {
            const glm::ivec2 block(unwrapped.corner_texcoords[corner] * glm::vec2(options.size) /
                                   16.0F);
            charts[{block.x, block.y}].insert(*unwrapped.chart[corner / 3]);
        }
        for (const auto& [block, inside] : charts)
            EXPECT_EQ(inside.size(), 1U) << height;
    }
}

// The padding around convex charts is known exactly, so that no packing can use more texels.
TEST_LABELS(not_sanitized);
TEST(Unwrap, StatesTheCostOfThePadding) {
    const Unwrapped plane = unwrap(test::flat_grid(20));
    const double side = std::sqrt(plane.stats.used) * 2048.0;
    EXPECT_NEAR(plane.stats.perimeter, 4.0 * side, 0.01);
    EXPECT_NEAR(plane.stats.padding_share.value(),
                (8.0 * side + 4.0 * std::numbers::pi) / (2048.0 * 2048.0), 1e-9);
    EXPECT_EQ(plane.stats.safe_mip_level, 0);

    Mesh soup = test::soup(make_sphere(12, 6));
    soup.texcoords = {};
    for (std::size_t v = 0; v < soup.positions.size(); ++v)
        soup.positions[v] += glm::vec3(5.0F * static_cast<float>(v / 3), 0.0F, 0.0F);
    UnwrapOptions options;
    options.size = {256, 256};
    double least_used = 1.0;
    for (const int padding : {0, 2, 6, 12}) {
        options.padding = padding;
        const AtlasStats stats = unwrap(soup, options).stats;
        EXPECT_EQ(stats.charts, 120U) << "144 triangles, of which 24 at the poles have no area";
        EXPECT_LE(stats.used + stats.padding_share.value(), 1.0) << padding;
        EXPECT_GT(stats.used + stats.padding_share.value(), 0.6) << padding;
        EXPECT_LT(stats.used, least_used);
        least_used = stats.used;
        EXPECT_EQ(stats.safe_mip_level, padding < 3 ? std::nullopt : std::optional(padding / 6))
            << "0 for 3 to 5, 1 for 6, 2 for 12";
    }
    options.padding = 4;
    const double single = unwrap(soup, options).stats.padding_share.value();
    options.tiles = 4;
    const AtlasStats tiled = unwrap(soup, options).stats;
    EXPECT_LT(tiled.padding_share.value(), 0.6 * single) << "charts are larger";
    EXPECT_LE(tiled.used + tiled.padding_share.value(), 1.0);
}

TEST(Unwrap, HasTheRequestedDensity) {
    UnwrapOptions options;
    options.texels_per_unit = 20.0;
    const Unwrapped unwrapped = unwrap(test::uneven_cube(), options);
    EXPECT_EQ(broken_promise(unwrapped), "");
    EXPECT_NEAR(unwrapped.stats.texels_per_unit, 20.0, 0.1);
    options.texels_per_unit = 2000.0;
    EXPECT_EQ(message_of<InvalidInput>([&] { unwrap(test::uneven_cube(), options); }),
              "the charts do not fit into the map at the requested density");
}

// Two triangles of a plane have one chart unless something must stay between them.
TEST(Unwrap, DividesChartsWhereThatIsRequested) {
    Mesh folded = test::ramp(1.0F, 1.0F);
    folded.texcoords.clear();
    UnwrapOptions options;
    options.size = {2048, 1024};  // A square map would divide the long chart.
    EXPECT_EQ(unwrap(folded, options).stats.charts, 1U);
    options.split_hard = 50.0 * std::numbers::pi / 180.0;
    EXPECT_EQ(unwrap(folded, options).stats.charts, 1U) << "the angle is 45 degrees";
    options.split_hard = 40.0 * std::numbers::pi / 180.0;
    EXPECT_EQ(unwrap(folded, options).stats.charts, 2U);

    Mesh square = test::square();
    square.material_ranges = {{0, 1, 0U}, {1, 1, 1U}};
    EXPECT_EQ(unwrap(square).stats.charts, 1U);
    options = {};
    options.split_materials = true;
    EXPECT_EQ(unwrap(square, options).stats.charts, 2U);

    const Mesh sphere = make_sphere(24, 12);
    options = {};
    options.keep_seams = true;
    const Unwrapped kept = unwrap(sphere, options);
    EXPECT_EQ(broken_promise(kept), "");
    // Along the seam of the sphere, all vertices have two places in the map.
    const FramedMesh framed = with_texcoords(sphere, kept);
    for (std::size_t v = 0; v < framed.source_vertex.size(); ++v)
        EXPECT_EQ(framed.mesh.positions[v], sphere.positions[framed.source_vertex[v]]);
}

TEST(Unwrap, RepacksItsOwnCharts) {
    Mesh sphere = make_sphere(24, 12);
    UnwrapOptions options;
    options.size = {512, 256};
    const Unwrapped first = unwrap(sphere, options);
    sphere = with_texcoords(sphere, first).mesh;
    options.repack = true;
    options.padding = 12;
    Report report;
    const Unwrapped second = unwrap(sphere, options, report);
    EXPECT_EQ(report.count("mirrored chart"), 0U);
    EXPECT_EQ(report.count("chart with overlapping or inverted triangles"), 0U);
    EXPECT_EQ(broken_promise(second), "");
    EXPECT_EQ(second.stats.charts, first.stats.charts);
    // Rounding to the lattice changes shapes by less than a thousandth of a texel.
    EXPECT_NEAR(second.stats.stretch, first.stats.stretch, 1e-3);
    EXPECT_GE(distances_of(second, {512, 256}).between, 12.0 - 1e-3);
}

TEST(Unwrap, FillsTiles) {
    Mesh sphere = make_sphere(24, 12);
    sphere.texcoords = {};
    UnwrapOptions options;
    options.size = {128, 128};
    options.split_hard = 0.0;  // Many charts.
    const AtlasStats single = unwrap(sphere, options).stats;
    options.tiles = 12;
    const Unwrapped unwrapped = unwrap(sphere, options);
    EXPECT_GE(unwrapped.stats.charts, 12U);
    EXPECT_GT(unwrapped.stats.texels_per_unit, 2.0 * single.texels_per_unit);
    EXPECT_NEAR(unwrapped.stats.max_density, unwrapped.stats.min_density, 0.1);
    std::map<std::uint32_t, std::set<std::pair<int, int>>> tiles_of_charts;
    std::set<std::pair<int, int>> all;
    // The same in one map, in which nothing may overlap either, with the tiles apart.
    Unwrapped apart = unwrapped;
    for (std::size_t t = 0; t < sphere.triangles.size(); ++t) {
        if (!unwrapped.chart[t]) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            glm::vec2& uv = apart.corner_texcoords[3 * t + i];
            EXPECT_EQ(std::floor(uv.x * 0x1p20), uv.x * 0x1p20) << "a coordinate off the lattice";
            EXPECT_EQ(std::floor(uv.y * 0x1p20), uv.y * 0x1p20);
            const std::pair tile(static_cast<int>(std::floor(uv.x)),
                                 static_cast<int>(std::floor(uv.y)));
            tiles_of_charts[*unwrapped.chart[t]].insert(tile);
            all.insert(tile);
            uv = (uv + glm::vec2(0.0F, 1.0F)) / 16.0F;
        }
    }
    for (const auto& [chart, tiles] : tiles_of_charts)
        EXPECT_EQ(tiles.size(), 1U) << chart;
    EXPECT_EQ(all.size(), 12U);
    EXPECT_EQ(*all.begin(), std::pair(0, -1)) << "the second row of tiles is above the first";
    EXPECT_TRUE(all.contains({9, 0}));
    EXPECT_EQ(broken_promise(apart), "");
}

/// Appends a copy of a mesh, transformed.
void append_copy(Mesh& mesh, const Mesh& part, const glm::mat3& rotation, const glm::vec3& shift) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& position : part.positions)
        mesh.positions.push_back(rotation * position + shift);
    for (const glm::uvec3& triangle : part.triangles)
        mesh.triangles.push_back(triangle + first);
}

// Few charts that are large for one tile are divided, and the tiles are balanced.
TEST(Unwrap, FillsTilesOfAFewCharts) {
    Mesh sphere = make_sphere(64, 32);
    sphere.texcoords.clear();
    UnwrapOptions options;
    options.size = {512, 512};
    const double whole = unwrap(sphere, options).stats.used;
    options.size = {256, 256};
    options.tiles = 4;
    const double tiles = unwrap(sphere, options).stats.used;
    EXPECT_GT(tiles, whole - 0.2);
    EXPECT_GT(tiles, 0.55);
}

TEST(Unwrap, StacksEqualParts) {
    // A part without symmetry.
    Mesh part = make_sphere(9, 6);
    for (glm::vec3& p : part.positions)
        p += glm::vec3(0.3F * p.y * p.y, 0.2F * p.x * p.z, 0.1F * p.x);
    const glm::mat3 identity(1.0F);
    const glm::mat3 rotation(0.36F, 0.48F, -0.8F, -0.8F, 0.6F, 0.0F, 0.48F, 0.64F, 0.6F);
    const glm::mat3 mirror(-1, 0, 0, 0, 1, 0, 0, 0, 1);
    Mesh mesh;
    append_copy(mesh, part, identity, {});
    append_copy(mesh, part, rotation, {5, 1, 0});
    append_copy(mesh, part, 1.01F * identity, {0, 5, 0});
    const auto before_mirrored = static_cast<std::uint32_t>(mesh.triangles.size());
    append_copy(mesh, part, mirror, {0, 0, 5});
    for (std::size_t t = before_mirrored; t < mesh.triangles.size(); ++t)
        std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    UnwrapOptions options;
    options.size = {256, 256};
    options.stack = true;
    const Unwrapped unwrapped = unwrap(mesh, options);
    EXPECT_EQ(unwrapped.stats.stacked_parts, 1U) << "others have another size or are mirrored";
    const std::size_t corners = 3 * part.triangles.size();
    const auto coordinates = [&](std::size_t which) {
        const auto begin =
            unwrapped.corner_texcoords.begin() + static_cast<std::ptrdiff_t>(which * corners);
        return std::vector(begin, begin + static_cast<std::ptrdiff_t>(corners));
    };
    EXPECT_EQ(coordinates(0), coordinates(1));
    EXPECT_EQ(unwrapped.chart[0], unwrapped.chart[part.triangles.size()]);
    EXPECT_NE(coordinates(0), coordinates(2));
    EXPECT_NE(coordinates(0), coordinates(3));
    EXPECT_EQ(broken_promise(unwrapped), "");

    mesh.material_ranges = {{0, static_cast<std::uint32_t>(part.triangles.size()), 0U},
                            {static_cast<std::uint32_t>(part.triangles.size()),
                             static_cast<std::uint32_t>(3 * part.triangles.size()), 1U}};
    EXPECT_EQ(unwrap(mesh, options).stats.stacked_parts, 0U) << "the materials differ";
}

TEST(Unwrap, StacksManyPartsInLinearTime) {
    // Symmetric parts, which match in several ways, and many that are nearly equal.
    Mesh mesh;
    const Mesh sphere = make_sphere(16, 8);
    for (int i = 0; i < 60; ++i)
        append_copy(mesh, sphere, glm::mat3(i < 40 ? 1.0F : 1.0F + 1e-3F * static_cast<float>(i)),
                    glm::vec3(3 * (i % 15), 3 * (i / 15), 0));
    UnwrapOptions options;
    options.size = {256, 256};
    options.stack = true;
    EXPECT_EQ(unwrap(mesh, options).stats.stacked_parts, 39U);
}

TEST(Unwrap, FollowsDensities) {
    Mesh square = test::square();
    square.texcoords = {};
    UnwrapOptions options;
    options.densities = {1.0F, 3.0F};
    const Unwrapped divided = unwrap(square, options);
    EXPECT_EQ(divided.stats.charts, 2U) << "the densities differ too much for one chart";
    EXPECT_EQ(broken_promise(divided), "");
    const auto area = [&](std::size_t triangle) {
        const glm::vec2* const uv = &divided.corner_texcoords[3 * triangle];
        return static_cast<double>(
            test::area_of(test::point_of(uv[0]), test::point_of(uv[1]), test::point_of(uv[2])));
    };
    EXPECT_NEAR(area(1) / area(0), 9.0, 0.01);
    options.densities = {1.0F, 1.9F};
    EXPECT_EQ(unwrap(square, options).stats.charts, 1U);
    options.densities = {1.0F};
    EXPECT_EQ(message_of<InvalidInput>([&] { unwrap(square, options); }),
              "there are 1 densities for 2 triangles");
    options.densities = {1.0F, 0.0F};
    EXPECT_EQ(message_of<InvalidInput>([&] { unwrap(square, options); }),
              "a relative density is 0, but must be finite and above 0");
}

TEST(Unwrap, KeepsPartsApart) {
    // Two cubes in the same place. As one part, each triangle of the second one is repeated.
    const Mesh cube = make_cube();
    Mesh two = cube;
    const auto count = static_cast<std::uint32_t>(cube.positions.size());
    two.positions.insert(two.positions.end(), cube.positions.begin(), cube.positions.end());
    for (const glm::uvec3& triangle : cube.triangles)
        two.triangles.push_back(triangle + count);
    two.normals = {};
    two.tangents = {};
    two.texcoords = {};
    UnwrapOptions options;
    options.size = {256, 256};
    const AtlasStats single = unwrap(cube, options).stats;
    options.first_vertices = {0, count};
    Report report;
    const Unwrapped apart = unwrap(two, options, report);
    EXPECT_TRUE(report.empty());
    EXPECT_EQ(apart.stats.charts, 2 * single.charts);
    EXPECT_EQ(broken_promise(apart), "");
    EXPECT_DOUBLE_EQ(apart.stats.area, 2.0 * single.area);
    options.first_vertices = {};
    unwrap(two, options, report);
    EXPECT_EQ(report.count("repeated triangle"), cube.triangles.size());
}

TEST(Unwrap, SplitsAtEveryEdgeThatIsNotFlat) {
    Mesh sphere = make_sphere(8, 4);
    sphere.texcoords = {};
    UnwrapOptions options;
    options.size = {256, 256};
    options.split_hard = 0.0;
    // Quads between the triangles of the caps.
    EXPECT_EQ(unwrap(sphere, options).stats.charts, 8U * 4U);
    Mesh square = test::square();
    for (glm::vec3& p : square.positions)
        p = {0.1F * p.x, 0.7F * p.x + 0.3F * p.y, 0.9F * p.y};  // Rounded, so not exactly flat.
    EXPECT_EQ(unwrap(square, options).stats.charts, 1U);
}

// All triangles are below a millionth of the area. Projected caps would have an L2 stretch of 1.1.
TEST_LABELS(slow);
TEST(Unwrap, FlattensMoreThanAMillionTriangles) {
    const Unwrapped unwrapped = unwrap(make_sphere(1000, 600));
    EXPECT_GT(unwrapped.chart.size(), 1'100'000U);
    EXPECT_LT(unwrapped.stats.stretch, 1.005);
    EXPECT_GT(unwrapped.stats.max_anisotropy, 1.0);
    EXPECT_LT(unwrapped.stats.max_anisotropy, 4.0);
}

TEST(Unwrap, RefusesOptionsOutOfRange) {
    const Mesh square = test::square();
    const auto message = [&](const UnwrapOptions& options) {
        return message_of<InvalidInput>([&] { unwrap(square, options); });
    };
    UnwrapOptions options;
    options.size = {2048, 8};
    EXPECT_EQ(message(options), "the size of the map is 8, but must be 16 to 65536 texels");
    options = {};
    options.padding = -1;
    EXPECT_EQ(message(options), "the padding is -1, but must be 0 to 256 texels");
    options = {};
    options.max_stretch = 1.0;
    EXPECT_EQ(message(options), "the stretch limit is 1, but must be above 1");
    options = {};
    options.size = {16, 16};
    options.padding = 16;
    EXPECT_EQ(message(options), "the padding leaves no room in the map");
    options = {};
    options.first_vertices = {0, 5};
    EXPECT_EQ(message(options), "the first vertices of the parts must ascend from 0");
    options = {};
    options.repack = true;
    Mesh plain = square;
    plain.texcoords = {};
    EXPECT_EQ(message_of<InvalidInput>([&] { unwrap(plain, options); }),
              "there are no texture coordinates to repack");
    Unwrapped other;
    EXPECT_EQ(message_of<InvalidInput>([&] { with_texcoords(square, other); }),
              "there are 0 texture coordinates for 2 triangles");
}

TEST(Unwrap, CanBeCancelled) {
    Progress progress;
    progress.cancel();
    UnwrapOptions options;
    options.execution.progress = &progress;
    EXPECT_THROW(unwrap(test::flat_grid(100), options), Cancelled);
}

}  // namespace
}  // namespace relief
