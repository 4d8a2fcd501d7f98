// SPDX-License-Identifier: Apache-2.0
// Displacement. On a plane the described surface is the height map itself, which the tests look up
// by their own interpolation.
#include "relief/mesh/displace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "mesh/topology/boundary_edges.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::boundary_edges;
using test::message_of;
using testing::HasSubstr;

constexpr float no_number = std::numeric_limits<float>::quiet_NaN();

Image heights_of(int width, int height, const std::vector<float>& values) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = 1;
    image.samples = values;
    return image;
}

Image random_heights(int side, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> values(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (float& value : values)
        value = static_cast<float>(random() % 1000) / 999.0F;
    return heights_of(side, side, values);
}

/// Waves of one period over the map, from 0 to 1.
Image waves(int side) {
    std::vector<float> values;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double u = (x + 0.5) / side;
            const double v = (y + 0.5) / side;
            values.push_back(static_cast<float>(0.5 + 0.25 * std::sin(2.0 * std::numbers::pi * u) +
                                                0.25 * std::cos(2.0 * std::numbers::pi * v)));
        }
    }
    return heights_of(side, side, values);
}

/// Returns the height of the triangles over a point of the square of make_quad().
double height_over(const Mesh& mesh, double x, double y) {
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b = glm::dvec3(mesh.positions[t.y]) - a;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t.z]) - a;
        const double area = b.x * c.y - b.y * c.x;
        const double of_b = ((x - a.x) * c.y - (y - a.y) * c.x) / area;
        const double of_c = (b.x * (y - a.y) - b.y * (x - a.x)) / area;
        constexpr double rounding = 1e-6;
        if (of_b < -rounding || of_c < -rounding || of_b + of_c > 1.0 + rounding) continue;
        return a.z + of_b * b.z + of_c * c.z;
    }
    ADD_FAILURE() << "no triangle at " << x << ", " << y;
    return 0.0;
}

/// Positions of triangles as a sorted list, each beginning at its smallest corner.
std::vector<std::array<std::array<float, 3>, 3>> sorted_triangles(const Mesh& mesh) {
    std::vector<std::array<std::array<float, 3>, 3>> result;
    for (const glm::uvec3& t : mesh.triangles) {
        std::array<std::array<float, 3>, 3> corners{};
        for (int k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[t[k]];
            corners[static_cast<std::size_t>(k)] = {p.x, p.y, p.z};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        result.push_back(corners);
    }
    std::sort(result.begin(), result.end());
    return result;
}

TEST(Displace, AnEvenMapMovesTheSurfaceAndDividesNothing) {
    const Image white = heights_of(2, 2, {1.0F, 1.0F, 1.0F, 1.0F});
    Report report;
    const DisplacedMesh result =
        displaced(make_quad(), white, {.height = 0.5, .zero = 0.25, .max_error = 1e-3}, report);
    ASSERT_EQ(result.mesh.triangles.size(), 2U);
    Mesh expected = make_quad();
    for (glm::vec3& position : expected.positions)
        position.z = 0.375F;
    EXPECT_EQ(sorted_triangles(result.mesh), sorted_triangles(expected));
    ASSERT_EQ(result.mesh.texcoords.size(), 4U);
    for (int i = 0; i < 4; ++i) {
        const glm::vec3& position = result.mesh.positions[i];
        EXPECT_EQ(result.mesh.texcoords[i],
                  glm::vec2(0.5F + 0.5F * position.x, 0.5F - 0.5F * position.y));
    }
    for (const glm::vec3& normal : result.mesh.normals)
        EXPECT_EQ(normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(result.max_error, 0.0);
    EXPECT_TRUE(report.empty());
}

// One texel of four is high. Between their centers the field is a bilinear patch, and outside of
// them it continues the border.
TEST(Displace, OnePatchByHand) {
    const Image one = heights_of(2, 2, {0.0F, 1.0F, 0.0F, 0.0F});
    const DisplacedMesh result =
        displaced(make_quad(), one, {.height = 1.0, .wrap = Wrap::clamp, .max_error = 0.01});
    const Mesh& mesh = result.mesh;
    EXPECT_NEAR(height_over(mesh, 0.5, 0.5), 1.0, 0.01) << "the center of the upper right texel";
    EXPECT_NEAR(height_over(mesh, 0.99, 0.99), 1.0, 0.01);
    EXPECT_NEAR(height_over(mesh, -0.5, 0.5), 0.0, 0.01);
    EXPECT_NEAR(height_over(mesh, 0.5, -0.5), 0.0, 0.01);
    EXPECT_NEAR(height_over(mesh, 0.5, 0.99), 1.0, 0.01) << "the border continues";
}

TEST(Displace, IsWithinTheErrorAtAllTexels) {
    const Image map = waves(64);
    std::size_t last = 0;
    for (const double bound : {0.1, 0.01, 0.001}) {
        const DisplacedMesh result =
            displaced(make_quad(), map, {.height = 0.5, .max_error = bound});
        EXPECT_EQ(result.above_limit, 0U) << bound;
        EXPECT_LE(result.max_error, bound);
        EXPECT_LT(result.rms_error, result.max_error);
        EXPECT_GT(result.mesh.triangles.size(), 2 * last) << bound;
        last = result.mesh.triangles.size();
        double largest = 0.0;
        for (int y = 0; y < 64; y += 3) {
            for (int x = 0; x < 64; x += 3) {
                const double value = map.as<float>()[static_cast<std::size_t>(64 * y + x)];
                const double here =
                    height_over(result.mesh, (x + 0.5) / 32.0 - 1.0, 1.0 - (y + 0.5) / 32.0);
                largest = std::max(largest, std::abs(here - 0.5 * value));
            }
        }
        EXPECT_LE(largest, bound * 1.001) << "float positions";
        EXPECT_GT(largest, 0.3 * bound) << "no more triangles than the bound asks for";
    }
    EXPECT_LT(last, 64U * 64U * 2U) << "fewer than a square for each texel";
}

TEST(Displace, NormalsAreThoseOfTheHeights) {
    const Image map = waves(128);
    const DisplacedMesh result = displaced(make_quad(), map, {.height = 0.5, .max_error = 0.001});
    double largest = 0.0;
    for (std::size_t i = 0; i < result.mesh.positions.size(); ++i) {
        const glm::dvec2 uv(result.mesh.texcoords[i]);
        // The square is two units wide, and v points down.
        const double pi = std::numbers::pi;
        const double along_x = 0.5 * 0.25 * std::cos(2.0 * pi * uv.x) * 2.0 * pi / 2.0;
        const double along_y = 0.5 * 0.25 * std::sin(2.0 * pi * uv.y) * 2.0 * pi / 2.0;
        const glm::dvec3 expected = glm::normalize(glm::dvec3(-along_x, -along_y, 1.0));
        const double cosine = glm::dot(expected, glm::dvec3(result.mesh.normals[i]));
        largest = std::max(largest, std::acos(std::min(cosine, 1.0)) * 180.0 / pi);
    }
    EXPECT_LT(largest, 0.05) << "degrees; the difference over one of 128 texels";
}

// Sphere: a texture seam and poles. Cube: hard edges. Torus: two seams.
TEST(Displace, ClosedSurfacesStayClosed) {
    const Image map = random_heights(24, 5);
    for (const Mesh& mesh : {make_sphere(16, 8), make_cube(), make_torus(0.4F, 12, 8)}) {
        ASSERT_EQ(boundary_edges(mesh), 0U);
        Report report;
        const DisplacedMesh result =
            displaced(mesh, map, {.height = 0.05, .max_error = 0.005}, report);
        EXPECT_EQ(boundary_edges(result.mesh), 0U);
        EXPECT_GT(result.mesh.triangles.size(), 1000U);
        for (const glm::vec3& normal : result.mesh.normals)
            ASSERT_NEAR(glm::length(normal), 1.0F, 1e-6F);
    }
}

TEST(Displace, TheOrderOfTrianglesAndVerticesChangesNoBit) {
    const Image map = random_heights(16, 7);
    const DisplaceOptions options{.height = 0.1, .max_error = 0.01};
    const Mesh mesh = make_sphere(12, 6);
    const DisplacedMesh expected = displaced(mesh, map, options);
    std::mt19937 random(3);
    for (int round = 0; round < 3; ++round) {
        Mesh shuffled = mesh;
        std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), random);
        const DisplacedMesh other = displaced(shuffled, map, options);
        EXPECT_EQ(sorted_triangles(other.mesh), sorted_triangles(expected.mesh));
        EXPECT_EQ(other.max_error, expected.max_error);
        EXPECT_EQ(other.rms_error, expected.rms_error);
        EXPECT_EQ(other.above_limit, expected.above_limit);
    }
}

TEST(Displace, MirroredAndNegativeMapsAreMirrored) {
    const Image map = random_heights(8, 11);
    Mesh mirrored = make_quad();
    for (glm::vec2& texcoord : mirrored.texcoords)
        texcoord.x = 1.0F - texcoord.x;
    const DisplaceOptions options{.height = 0.3, .wrap = Wrap::clamp, .max_error = 0.005};
    DisplaceOptions inwards = options;
    inwards.height = -0.3;
    const Mesh plain = displaced(make_quad(), map, options).mesh;
    const Mesh reversed = displaced(mirrored, map, options).mesh;
    const Mesh below = displaced(make_quad(), map, inwards).mesh;
    // The triangles differ, because the diagonal of the square is not mirrored.
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
            const double at_x = (x + 0.5) / 4.0 - 1.0;
            const double at_y = (y + 0.5) / 4.0 - 1.0;
            EXPECT_NEAR(height_over(reversed, -at_x, at_y), height_over(plain, at_x, at_y), 0.01);
            EXPECT_NEAR(height_over(below, at_x, at_y), -height_over(plain, at_x, at_y), 0.01);
        }
    }
}

TEST(Displace, EndsAtTheLargestNumberOfTriangles) {
    const DisplacedMesh result =
        displaced(make_quad(), random_heights(64, 1),
                  {.height = 1.0, .max_error = 1e-4, .max_triangles = 1000});
    EXPECT_FALSE(result.is_complete);
    EXPECT_LE(result.mesh.triangles.size(), 1000U);
    EXPECT_GT(result.mesh.triangles.size(), 250U);
    EXPECT_GT(result.above_limit, 250U);
    EXPECT_GT(result.max_error, 0.1);
    EXPECT_EQ(boundary_edges(result.mesh) % 4, 0U);
}

TEST(Displace, NoiseEndsAtTrianglesOfHalfATexel) {
    const DisplacedMesh result = displaced(make_quad(), random_heights(32, 2),
                                           {.height = 1.0, .wrap = Wrap::clamp, .max_error = 1e-9});
    EXPECT_TRUE(result.is_complete);
    EXPECT_EQ(result.mesh.triangles.size(), 2U * 64U * 64U);
}

TEST(Displace, MaterialsGroupsAndColorsStay) {
    Mesh mesh = make_quad(2);
    mesh.material_ranges = {{0, 3, 1}, {3, 5, 0}};
    mesh.smoothing_groups = {1, 1, 1, 1, 2, 2, 2, 2};
    for (const glm::vec3& position : mesh.positions)
        mesh.colors.emplace_back(position, 1.0F);
    const Mesh fine =
        displaced(mesh, random_heights(16, 3), {.height = 0.1, .max_error = 0.01}).mesh;
    ASSERT_EQ(fine.material_ranges.size(), 2U);
    EXPECT_EQ(fine.material_ranges[0].material, 1U);
    EXPECT_EQ(fine.material_ranges[1].material, 0U);
    EXPECT_EQ(fine.material_ranges[0].triangle_count, fine.material_ranges[1].first_triangle);
    EXPECT_GT(fine.material_ranges[0].triangle_count, 30U);
    EXPECT_EQ(std::count(fine.smoothing_groups.begin(), fine.smoothing_groups.end(), 1U) +
                  std::count(fine.smoothing_groups.begin(), fine.smoothing_groups.end(), 2U),
              static_cast<std::ptrdiff_t>(fine.triangles.size()));
    EXPECT_NO_THROW(validate(fine));
    for (std::size_t i = 0; i < fine.positions.size(); ++i) {
        EXPECT_NEAR(fine.colors[i].x, fine.positions[i].x, 1e-6);
        EXPECT_NEAR(fine.colors[i].y, fine.positions[i].y, 1e-6);
    }
}

TEST(Displace, UnusableInputIsCountedAndKept) {
    Mesh mesh = make_quad(2);
    mesh.normals.clear();
    mesh.positions.emplace_back(no_number, 0.0F, 0.0F);
    mesh.texcoords.emplace_back(0.0F, 0.0F);
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    mesh.triangles.insert(mesh.triangles.begin() + 1, {0, 1, last});
    mesh.triangles.emplace_back(0, 1, 0);
    std::vector<float> values(64, 0.0F);
    values[9] = no_number;
    values[27] = 1.0F;
    Report report;
    const Mesh fine =
        displaced(mesh, heights_of(8, 8, values), {.height = 0.2, .max_error = 0.01}, report).mesh;
    EXPECT_EQ(report.count("triangle with a non-finite position"), 1U);
    EXPECT_EQ(report.count("collapsed triangle"), 1U);
    EXPECT_EQ(report.count("non-finite height"), 1U);
    EXPECT_NO_THROW(validate(fine));
    std::size_t finite = 0;
    for (const glm::vec3& position : fine.positions)
        finite += std::isfinite(position.x) ? 1 : 0;
    EXPECT_EQ(finite, fine.positions.size() - 1);

    Mesh without_place = make_quad(2);
    without_place.texcoords[4].x = no_number;
    Report of_texcoords;
    const DisplacedMesh partly = displaced(without_place, heights_of(8, 8, values),
                                           {.height = 0.2, .max_error = 0.01}, of_texcoords);
    EXPECT_EQ(of_texcoords.count("non-finite texture coordinate"), 6U);
    for (const glm::vec3& position : partly.mesh.positions)
        EXPECT_TRUE(std::isfinite(position.z));
}

// A wall of two sheets back to back: each moves along its own normals.
TEST(Displace, SheetsOfADoubledWallMoveApart) {
    Mesh wall = make_quad();
    const auto count = static_cast<std::uint32_t>(wall.positions.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        wall.positions.push_back(wall.positions[i]);
        wall.normals.push_back(-wall.normals[i]);
        wall.texcoords.push_back(wall.texcoords[i]);
    }
    wall.tangents.clear();
    const std::vector<glm::uvec3> front = wall.triangles;
    for (const glm::uvec3& t : front)
        wall.triangles.emplace_back(t.x + count, t.z + count, t.y + count);
    Report report;
    const Mesh fine =
        displaced(wall, heights_of(1, 1, {1.0F}), {.height = 0.25, .max_error = 0.01}, report).mesh;
    std::size_t above = 0;
    std::size_t below = 0;
    for (const glm::vec3& position : fine.positions) {
        above += position.z == 0.25F ? 1 : 0;
        below += position.z == -0.25F ? 1 : 0;
    }
    EXPECT_EQ(above, fine.positions.size() / 2);
    EXPECT_EQ(below, fine.positions.size() / 2);
}

TEST(Displace, FoldsAreCounted) {
    // The wall of a cylinder of radius 1 that moves inwards by 2 faces its axis.
    Mesh wall = make_cylinder(16);
    std::vector<std::uint32_t> sides;
    for (std::uint32_t t = 0; t < wall.triangles.size(); ++t) {
        if (wall.normals[wall.triangles[t].x].y == 0.0F) sides.push_back(t);
    }
    ASSERT_EQ(sides.size(), 32U);
    Report report;
    displaced(part_of(wall, sides), heights_of(1, 1, {1.0F}), {.height = -2.0, .max_error = 1.0},
              report);
    EXPECT_EQ(report.count("triangle turned over in parts"), 32U);
}

TEST(Displace, BadOptionsAreRefused) {
    const Image map = waves(4);
    const auto message = [&](const Mesh& mesh, const Image& image, const DisplaceOptions& options) {
        return message_of<InvalidInput>([&] { displaced(mesh, image, options); });
    };
    EXPECT_THAT(message(make_quad(), map, {.height = 1.0, .max_error = 0.0}),
                HasSubstr("the largest error is 0, but must be above 0"));
    EXPECT_THAT(message(make_quad(), map, {.height = no_number, .max_error = 0.1}),
                HasSubstr("the height is nan, but must be finite"));
    Mesh bare = make_quad();
    bare.texcoords.clear();
    bare.tangents.clear();
    EXPECT_THAT(message(bare, map, {.height = 1.0, .max_error = 0.1}),
                HasSubstr("no texture coordinates"));
    Image color = map;
    color.channels = 4;
    color.width = 1;
    EXPECT_THAT(message(make_quad(), color, {.height = 1.0, .max_error = 0.1}),
                HasSubstr("has 4 channels, but must have 1"));
    EXPECT_TRUE(displaced({}, map, {.height = 1.0, .max_error = 0.1}).mesh.triangles.empty());
}

}  // namespace
}  // namespace relief
