// SPDX-License-Identifier: Apache-2.0
// Vertex normals: hand-computed values, every hard mesh, the sphere, and weights that depend on
// the mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/geometry/normal_samples.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shapes.h"

namespace relief {
namespace {

using test::all_weights;
using test::bumpy_ball;
using test::degrees_between;
using test::facing_up;
using test::float_degrees;
using test::normals_of;

void expect_unit(const std::vector<glm::vec3>& normals) {
    for (std::size_t i = 0; i < normals.size(); ++i) {
        // The condition fails for NaN. Three rounded floats have an error of 1e-7.
        ASSERT_TRUE(std::abs(glm::length(glm::dvec3(normals[i])) - 1.0) <= 2e-7) << "normal " << i;
    }
}

/// A cube of eight vertices; bit i of `splits` selects the diagonal of face i.
Mesh welded_cube(unsigned splits) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                                    (i & 4) != 0 ? 1 : -1);
    const std::array<glm::uvec4, 6> faces = {glm::uvec4(0, 2, 3, 1), {4, 5, 7, 6}, {0, 1, 5, 4},
                                             {2, 6, 7, 3},           {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (unsigned face = 0; face < 6; ++face) {
        const glm::uvec4& q = faces[face];
        if ((splits >> face & 1U) != 0) {
            mesh.triangles.emplace_back(q.x, q.y, q.z);
            mesh.triangles.emplace_back(q.x, q.z, q.w);
        } else {
            mesh.triangles.emplace_back(q.x, q.y, q.w);
            mesh.triangles.emplace_back(q.y, q.z, q.w);
        }
    }
    return mesh;
}

TEST(VertexNormals, AFlatGridPointsUpExactly) {
    for (const NormalWeight weight : all_weights) {
        for (const glm::vec3& normal : normals_of(test::grid(4), weight))
            EXPECT_EQ(normal, facing_up);
    }
}

TEST(VertexNormals, AreaWeightsFollowTheAreas) {
    // A triangle of area 2 facing +z and one of area 1/2 facing +x share an edge.
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {0, 1, 0}, {-4, 0, 0}, {0, 0, -1}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {1, 0, 3}};
    Report report;
    const auto normals = vertex_normals(positions, triangles, NormalWeight::area, report);
    EXPECT_LE(degrees_between(normals[0], glm::dvec3(1, 0, 4)), float_degrees);
    EXPECT_EQ(normals[2], facing_up);
    EXPECT_EQ(normals[3], glm::vec3(1, 0, 0));
    EXPECT_TRUE(report.empty());
}

TEST(VertexNormals, AngleWeightsFollowTheAngles) {
    // Vertex 0 has a corner of 45 degrees facing +z and one of 90 degrees facing +x.
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {0, 0, -1}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {1, 0, 3}};
    Report report;
    const auto normals = vertex_normals(positions, triangles, NormalWeight::angle, report);
    EXPECT_LE(degrees_between(normals[0], glm::dvec3(2, 0, 1)), float_degrees);
    // Vertex 1 has 90 degrees facing +z and 45 degrees facing +x.
    EXPECT_LE(degrees_between(normals[1], glm::dvec3(1, 0, 2)), float_degrees);
}

TEST(VertexNormals, AngleWeightsGiveACubeItsDiagonalsHoweverItsFacesAreSplit) {
    double worst_by_area = 0.0;
    for (unsigned splits = 0; splits < 64; ++splits) {
        const Mesh cube = welded_cube(splits);
        const auto by_angle = normals_of(cube, NormalWeight::angle);
        const auto by_area = normals_of(cube, NormalWeight::area);
        for (std::size_t i = 0; i < 8; ++i) {
            const glm::dvec3 diagonal(cube.positions[i]);
            EXPECT_LE(degrees_between(by_angle[i], diagonal), float_degrees);
            worst_by_area = std::max(worst_by_area, degrees_between(by_area[i], diagonal));
        }
    }
    // Two triangles of one face against one of each other face: the angle between (2,1,1) and
    // (1,1,1) is 19.47 degrees, the error of area weights.
    EXPECT_NEAR(worst_by_area, std::acos(4.0 / std::sqrt(18.0)) * 180.0 / std::numbers::pi, 1e-4);
}

TEST(VertexNormals, MaxIsExactOnAnyTriangulationOfASphere) {
    // Any closed polyhedron with its vertices on a sphere [Max 1999], here with irregular
    // triangles.
    Mesh mesh = test::sphere(24, 12);
    for (glm::vec3& p : mesh.positions) {
        const glm::dvec3 moved =
            glm::dvec3(p) + 0.06 * glm::dvec3(std::sin(9.0 * p.y), std::sin(8.0 * p.z), p.x * p.y);
        p = glm::vec3(glm::normalize(moved));
    }
    double worst_by_angle = 0.0;
    const auto by_max = normals_of(mesh, NormalWeight::max);
    const auto by_angle = normals_of(mesh, NormalWeight::angle);
    for (std::size_t i = 0; i < by_max.size(); ++i) {
        // Positions rounded to float have a distance of 6e-8 to the sphere, with edges of 0.05.
        EXPECT_LE(degrees_between(by_max[i], glm::dvec3(mesh.positions[i])), 3e-4);
        worst_by_angle =
            std::max(worst_by_angle, degrees_between(by_angle[i], glm::dvec3(mesh.positions[i])));
    }
    EXPECT_GT(worst_by_angle, 0.5);
}

TEST(VertexNormals, VerticesWithinTheToleranceShareTheirNormal) {
    // Two perpendicular squares, 1e-4 apart along the common edge.
    const float gap = 1e-4F;
    const std::vector<glm::vec3> positions = {{-1, 0, 0},  {0, 0, 0},    {0, 1, 0},
                                              {gap, 0, 0}, {gap, 0, -1}, {gap, 1, 0}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {3, 4, 5}};
    Report report;
    const auto with = [&](std::optional<double> tolerance) {
        NormalOptions options;
        options.weight = NormalWeight::uniform;
        options.weld_tolerance = tolerance;
        return vertex_normals(positions, triangles, options, report);
    };
    EXPECT_EQ(with(0.0)[1], facing_up);
    EXPECT_EQ(with(0.9e-4)[1], facing_up);
    EXPECT_LE(degrees_between(with(1.1e-4)[1], glm::dvec3(1, 0, 1)), float_degrees);
    EXPECT_EQ(with(1.1e-4)[1], with(1.1e-4)[3]);
    EXPECT_EQ(with(1.1e-4)[0], facing_up);
    EXPECT_TRUE(report.empty());
    EXPECT_THROW(with(-1.0), InvalidInput);
    EXPECT_THROW(with(std::numeric_limits<double>::quiet_NaN()), InvalidInput);
}

TEST(VertexNormals, WithoutSharingEveryVertexIsAlone) {
    const Mesh cube = test::cube();
    Report report;
    const auto normals =
        vertex_normals(cube.positions, cube.triangles,
                       {NormalWeight::angle, Arithmetic::float64, std::nullopt}, report);
    EXPECT_EQ(normals, cube.normals);
}

TEST(VertexNormals, ATextureSeamDoesNotShow) {
    const Mesh sphere = test::sphere(24, 12);
    for (const NormalWeight weight : all_weights) {
        const auto normals = normals_of(sphere, weight);
        std::size_t shared = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                if (sphere.positions[i] != sphere.positions[j]) continue;
                EXPECT_EQ(normals[i], normals[j]);
                ++shared;
            }
        }
        EXPECT_EQ(shared, 11U + 2U * (25U * 24U / 2U));
    }
}

TEST(VertexNormals, AnIsolatedVertexPointsUpAndIsCounted) {
    Mesh mesh = test::grid(1);
    mesh.positions.emplace_back(5, 5, 5);
    Report report;
    const auto normals =
        vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, report);
    EXPECT_EQ(normals.back(), facing_up);
    ASSERT_EQ(report.findings().size(), 1U);
    EXPECT_EQ(report.findings()[0],
              (Finding{"isolated vertex", "vertex", "gets the normal (0,0,1)", 1, {4}}));
}

TEST(VertexNormals, AnUnusedVertexAtAUsedPositionSharesItsNormal) {
    std::vector<glm::vec3> positions = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    Report report;
    const auto normals =
        vertex_normals(positions, std::vector<glm::uvec3>{{0, 1, 2}}, NormalWeight::area, report);
    EXPECT_EQ(normals[3], glm::vec3(1, 0, 0));
    EXPECT_TRUE(report.empty());
}

TEST(VertexNormals, DegenerateTrianglesHaveNoSayAndAreCounted) {
    const std::vector<glm::vec3> positions = {
        {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 0, 1}, {2, 3, 4}, {0, 3, 4}};
    Report report;
    const auto normals = vertex_normals(positions, triangles, NormalWeight::angle, report);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(normals[i], glm::vec3(1, 0, 0));
    EXPECT_EQ(normals[3], facing_up);
    EXPECT_EQ(normals[4], facing_up);
    EXPECT_EQ(report.count("degenerate triangle"), 3U);
    EXPECT_EQ(report.count("vertex with only degenerate triangles"), 2U);
    EXPECT_EQ(report.findings().size(), 2U);
}

TEST(VertexNormals, ASheetWithTwoFacesCancelsPointsUpAndIsCounted) {
    // The triangles are oblique, so that no component is zero.
    const std::vector<glm::vec3> positions = {
        {0.1F, 0.2F, 0.3F}, {1.3F, 0.1F, 0.7F}, {0.4F, 1.1F, 0.9F}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 2, 1}};
    for (const NormalWeight weight : all_weights) {
        Report report;
        const auto normals = vertex_normals(positions, triangles, weight, report);
        for (const glm::vec3& normal : normals)
            EXPECT_EQ(normal, facing_up);
        EXPECT_EQ(report.count("cancelling normals"), 3U);
        EXPECT_EQ(report.findings().size(), 1U);
    }
}

TEST(VertexNormals, AThinLensStillHasARim) {
    // Two faces that almost cancel: the sum points out of the rim, as intended.
    const float thin = 1e-6F;
    const std::vector<glm::vec3> positions = {
        {0, 0, 0}, {-1, -1, thin}, {-1, 1, thin}, {-1, -1, -thin}, {-1, 1, -thin}};
    const std::vector<glm::uvec3> triangles = {{0, 2, 1}, {0, 3, 4}};
    Report report;
    const auto normals = vertex_normals(positions, triangles, NormalWeight::area, report);
    EXPECT_LE(degrees_between(normals[0], glm::dvec3(1, 0, 0)), float_degrees);
    EXPECT_TRUE(report.empty());
}

TEST(VertexNormals, ANonFiniteVertexDisturbsOnlyItsOwnTriangles) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Mesh mesh = test::grid(4);
        mesh.positions[12].x = bad;  // The center vertex with six triangles.
        Report report;
        const auto normals =
            vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, report);
        for (const glm::vec3& normal : normals)
            EXPECT_EQ(normal, facing_up);
        EXPECT_EQ(report.count("non-finite position"), 1U);
        EXPECT_EQ(report.count("triangle with a non-finite corner"), 6U);
        EXPECT_EQ(report.findings().size(), 2U);
    }
}

TEST(VertexNormals, ANeedleOfAMillionthHasAnExactNormal) {
    // A needle from the origin with a width of 1e-6, in the plane x = z, far from the axes in
    // float.
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 1}, {0.5F, 1e-6F, 0.5F}};
    for (const NormalWeight weight : all_weights) {
        Report report;
        const auto normals =
            vertex_normals(positions, std::vector<glm::uvec3>{{0, 1, 2}}, weight, report);
        for (const glm::vec3& normal : normals)
            EXPECT_LE(degrees_between(normal, glm::dvec3(-1, 0, 1)), float_degrees);
        EXPECT_TRUE(report.empty());
    }
}

TEST(VertexNormals, ScaleDoesNotMatter) {
    const Mesh sphere = test::sphere(16, 8);
    for (const NormalWeight weight : all_weights) {
        const auto expected = normals_of(sphere, weight);
        for (const float scale : {1e-30F, 1e-12F, 1e18F, 1e30F}) {
            Mesh scaled = sphere;
            for (glm::vec3& position : scaled.positions)
                position *= scale;
            const auto normals = normals_of(scaled, weight);
            for (std::size_t i = 0; i < normals.size(); ++i) {
                // Scaling rounds positions by 6e-8. The smallest triangles, at the poles, have a
                // width of 0.08 and magnify that by 20.
                EXPECT_LE(degrees_between(normals[i], expected[i]), 1e-4) << "scale " << scale;
            }
        }
    }
}

TEST(VertexNormals, AreUnitOnEveryHardMesh) {
    for (const test::NamedMesh& hard : test::hard_meshes()) {
        SCOPED_TRACE(hard.name);
        for (const NormalWeight weight : all_weights)
            expect_unit(normals_of(hard.mesh, weight));
        Report report;
        expect_unit(triangle_normals(hard.mesh.positions, hard.mesh.triangles, report));
    }
}

TEST(VertexNormals, RotateWithTheMesh) {
    // A rotation by exact numbers (3-4-5), so that rotated floats have only rounding errors.
    const glm::dmat3 rotation(0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0);
    const Mesh sphere = test::sphere(16, 8);
    Mesh rotated = sphere;
    for (glm::vec3& position : rotated.positions)
        position = rotation * glm::dvec3(position);
    for (const NormalWeight weight : all_weights) {
        const auto before = normals_of(sphere, weight);
        const auto after = normals_of(rotated, weight);
        for (std::size_t i = 0; i < before.size(); ++i) {
            // The error equals that of ScaleDoesNotMatter.
            EXPECT_LE(degrees_between(after[i], rotation * glm::dvec3(before[i])), 1e-4);
        }
    }
}

TEST(VertexNormals, ApproachTheSphereAtSecondOrder) {
    for (const NormalWeight weight : all_weights) {
        if (weight == NormalWeight::max)
            continue;  // This weight is exact except for float
                       // rounding.
        std::vector<double> errors;
        for (const int stacks : {16, 32, 64, 128}) {
            const Mesh sphere = test::sphere(2 * stacks, stacks);
            const auto normals = normals_of(sphere, weight);
            double squares = 0.0;
            std::size_t count = 0;
            for (std::size_t i = 0; i < normals.size(); ++i) {
                // The test omits the poles, where triangles change their shape when they shrink.
                if (std::abs(sphere.positions[i].y) > 0.8F) continue;
                squares += std::pow(degrees_between(normals[i], sphere.normals[i]), 2);
                ++count;
            }
            errors.push_back(std::sqrt(squares / static_cast<double>(count)));
        }
        for (std::size_t i = 1; i < errors.size(); ++i) {
            // Halving the edges must quarter the error. The band of 0.8 contains a slightly
            // different part of the rows each time.
            EXPECT_NEAR(errors[i - 1] / errors[i], 4.0, 0.4);
        }
        EXPECT_LT(errors.back(), 0.01);
    }
}

TEST_LABELS(not_sanitized);
TEST(VertexNormals, AFanOfAMillionTrianglesIsSummedExactly) {
    // A flat fan: every contribution is the same for any number of triangles.
    const std::uint32_t count = 1000000;
    std::vector<glm::vec3> positions = {{0, 0, 0}};
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        triangles.emplace_back(0, i + 1, (i + 1) % count + 1);
    }
    Report report;
    const auto normals = vertex_normals(positions, triangles, NormalWeight::angle, report);
    EXPECT_EQ(normals[0], facing_up);
    EXPECT_EQ(normals[count / 2], facing_up);
    EXPECT_TRUE(report.empty());
}

TEST(VertexNormals, AnIndexOutOfRangeIsRefused) {
    const std::vector<glm::vec3> positions(3);
    Report report;
    EXPECT_THAT(
        [&] {
            vertex_normals(positions, std::vector<glm::uvec3>{{0, 1, 3}}, NormalWeight::area,
                           report);
        },
        testing::ThrowsMessage<InvalidInput>(
            testing::StrEq("triangle 0 names vertex 3, but there are only 3")));
    EXPECT_THROW(triangle_normals(positions, std::vector<glm::uvec3>{{7, 1, 2}}, report),
                 InvalidInput);
}

TEST(TriangleNormals, FollowTheRightHand) {
    const std::vector<glm::vec3> positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
    Report report;
    const auto normals = triangle_normals(
        positions, std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 1}, {0, 2, 3}, {1, 2, 3}}, report);
    EXPECT_EQ(normals[0], facing_up);
    EXPECT_EQ(normals[1], -facing_up + 0.0F);
    EXPECT_EQ(normals[2], glm::vec3(1, 0, 0));
    EXPECT_LE(degrees_between(normals[3], glm::dvec3(6, 4, 3)), float_degrees);
    EXPECT_TRUE(report.empty());
}

TEST(TriangleNormals, WithoutAreaOrFiniteCornersPointUpAndAreCounted) {
    const std::vector<glm::vec3> positions = {
        {0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {std::numeric_limits<float>::infinity(), 0, 0}};
    Report report;
    const auto normals = triangle_normals(
        positions, std::vector<glm::uvec3>{{0, 1, 2}, {1, 1, 2}, {0, 1, 3}}, report);
    for (const glm::vec3& normal : normals)
        EXPECT_EQ(normal, facing_up);
    EXPECT_EQ(report.count("degenerate triangle"), 2U);
    EXPECT_EQ(report.count("triangle with a non-finite corner"), 1U);
}

TEST(ChosenNormals, AreMaxWithoutFolds) {
    const Mesh mesh = bumpy_ball();
    Report report;
    const ChosenNormals chosen = chosen_normals(mesh.positions, mesh.triangles, {}, report);
    EXPECT_EQ(chosen.by_area, 0U);
    EXPECT_TRUE(test::same_bits(chosen.normals, normals_of(mesh, NormalWeight::max)));
}

TEST(ChosenNormals, AreAreaAroundAFoldAndMaxElsewhere) {
    // A flat grid with one vertex moved over its neighbor: the inverted triangles are the small
    // ones, which have the largest weights of Max.
    Mesh mesh = test::grid(8);
    const std::size_t pulled = 4 * 9 + 4;
    mesh.positions[pulled] = {0.5F + 0.14F, 0.5F, 0.0F};
    Report report;
    const ChosenNormals chosen = chosen_normals(mesh.positions, mesh.triangles, {}, report);
    const auto by_max = normals_of(mesh, NormalWeight::max);
    const auto by_area = normals_of(mesh, NormalWeight::area);
    double worst_by_max = 0.0;
    for (std::size_t i = 0; i < by_max.size(); ++i) {
        EXPECT_LE(degrees_between(chosen.normals[i], facing_up),
                  degrees_between(by_area[i], facing_up))
            << i;
        worst_by_max = std::max(worst_by_max, degrees_between(by_max[i], facing_up));
    }
    EXPECT_GT(worst_by_max, 90.0);
    EXPECT_GT(chosen.by_area, 0U);
    EXPECT_LT(chosen.by_area, 8U);
    EXPECT_TRUE(report.empty());
}

}  // namespace
}  // namespace relief
