// SPDX-License-Identifier: Apache-2.0
// Meshes: validity and its error messages, corner numbers, parts of a mesh, transformed meshes,
// split vertices, and the basic shapes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "geometry/check_triangles.h"
#include "geometry/corners.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::degrees_between;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StrEq;

void expect_invalid(const Mesh& mesh, const char* message) {
    EXPECT_THAT([&] { validate(mesh); }, testing::ThrowsMessage<InvalidInput>(StrEq(message)));
}

TEST(Mesh, ShapesAndTheEmptyMeshAreValid) {
    EXPECT_NO_THROW(validate(Mesh{}));
    EXPECT_NO_THROW(validate(test::grid(3)));
    EXPECT_NO_THROW(validate(test::sphere(8, 4)));
    EXPECT_NO_THROW(validate(test::cube()));
}

TEST(Mesh, AnIndexBeyondTheVerticesIsNamedWithItsTriangleAndTheLimit) {
    Mesh mesh = test::grid(2);
    mesh.triangles[7].z = 12;
    expect_invalid(mesh, "triangle 7 names vertex 12, but there are only 9");
}

TEST(Mesh, AnAttributeOfAnotherLengthIsNamed) {
    Mesh mesh = test::grid(1);
    mesh.normals.pop_back();
    expect_invalid(mesh, "there are 3 normals, but 4 positions");
    mesh = test::grid(1);
    mesh.texcoords.emplace_back();
    expect_invalid(mesh, "there are 5 texture coordinates, but 4 positions");
    mesh = test::grid(1);
    mesh.tangents.resize(1);
    expect_invalid(mesh, "there are 1 tangents, but 4 positions");
    mesh = test::grid(1);
    mesh.colors.resize(2);
    expect_invalid(mesh, "there are 2 colors, but 4 positions");
}

TEST(Mesh, MaterialRangesCoverAllTrianglesWithoutGapOrOverlap) {
    Mesh mesh = test::grid(2);
    mesh.material_ranges = {{0, 3, 1}, {3, 5, std::nullopt}};
    EXPECT_NO_THROW(validate(mesh));
    mesh.material_ranges[1].first_triangle = 4;
    expect_invalid(mesh, "a material range starts at triangle 4 instead of 3");
    mesh.material_ranges = {{0, 3, 1}};
    expect_invalid(mesh, "material ranges cover 3 triangles, but there are 8");
}

TEST(Mesh, CornersThatCannotBeNumberedAreRefused) {
    // Such a mesh takes 17 GB, so the span has one readable triangle. The function must not read
    // it.
    const glm::uvec3 triangle(0, 0, 0);
    const std::span<const glm::uvec3> too_many(&triangle, 1'431'655'766);
    EXPECT_THAT([&] { check_triangles(too_many, 1); },
                testing::ThrowsMessage<InvalidInput>(
                    StrEq("there are 1431655766 triangles, but no more than 1431655765 can be "
                          "numbered")));
}

TEST(Mesh, BoundsIgnoreNonFinitePositions) {
    EXPECT_TRUE(bounds_of(Mesh{}).empty());
    Mesh mesh;
    mesh.positions = {{1, 5, -2}, {-1, 2, 3}};
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 100, 100);
    mesh.positions.emplace_back(100, std::numeric_limits<float>::infinity(), 100);
    const Bounds bounds = bounds_of(mesh);
    EXPECT_FALSE(bounds.empty());
    EXPECT_EQ(bounds.min, glm::vec3(-1, 2, -2));
    EXPECT_EQ(bounds.max, glm::vec3(1, 5, 3));
}

const std::vector<glm::uvec3> skewed_quad = {{0, 1, 2}, {0, 2, 4}};

TEST(Corners, GoAroundTheirTriangle) {
    EXPECT_EQ(triangle_of(5), 1U);
    EXPECT_EQ(next_in_triangle(3), 4U);
    EXPECT_EQ(next_in_triangle(5), 3U);
    EXPECT_EQ(previous_in_triangle(3), 5U);
    EXPECT_EQ(previous_in_triangle(5), 4U);
    EXPECT_EQ(vertex_of(5, skewed_quad), 4U);
}

TEST(Corners, AreListedByVertexInAscendingOrder) {
    const CornersByVertex corners(5, skewed_quad);
    EXPECT_EQ(corners.vertex_count(), 5U);
    EXPECT_THAT(corners.at(0), ElementsAre(0, 3));
    EXPECT_THAT(corners.at(1), ElementsAre(1));
    EXPECT_THAT(corners.at(2), ElementsAre(2, 4));
    EXPECT_THAT(corners.at(3), IsEmpty());
    EXPECT_THAT(corners.at(4), ElementsAre(5));
}

TEST(Corners, ExcludedTrianglesHaveNone) {
    const CornersByVertex corners(5, skewed_quad,
                                  [](std::size_t triangle) { return triangle == 1; });
    EXPECT_THAT(corners.at(0), ElementsAre(3));
    EXPECT_THAT(corners.at(1), IsEmpty());
}

TEST(MeshPart, HasTheVerticesThatItsTrianglesUseInTheirOrder) {
    Mesh mesh = make_quad();
    mesh.name = "quad";
    mesh.triangles = {{0, 1, 2}, {2, 3, 0}, {3, 2, 1}};
    mesh.smoothing_groups = {1, 2, 3};
    mesh.material_ranges = {{0, 1, 7U}, {1, 2, std::nullopt}};
    mesh.colors.assign(4, glm::vec4(0.5F));
    mesh.colors[3] = glm::vec4(1.0F);
    const std::vector<std::uint32_t> chosen = {2, 1};
    const Mesh part = part_of(mesh, chosen);
    EXPECT_NO_THROW(validate(part));
    EXPECT_EQ(part.name, "quad");
    EXPECT_EQ(part.positions, mesh.positions);
    EXPECT_THAT(part.triangles, ElementsAre(glm::uvec3(3, 2, 1), glm::uvec3(2, 3, 0)));
    EXPECT_THAT(part.smoothing_groups, ElementsAre(3, 2));
    EXPECT_THAT(part.material_ranges, ElementsAre(MaterialRange{0, 2, std::nullopt}));
    const std::vector<std::uint32_t> last = {2, 0, 2};
    mesh.triangles[0] = {3, 2, 1};
    const Mesh three = part_of(mesh, last);
    EXPECT_EQ(three.positions.size(), 3U);
    EXPECT_EQ(three.positions[0], mesh.positions[1]);
    EXPECT_EQ(three.colors[2], glm::vec4(1.0F));
    EXPECT_THAT(three.triangles,
                ElementsAre(glm::uvec3(2, 1, 0), glm::uvec3(2, 1, 0), glm::uvec3(2, 1, 0)));
    EXPECT_THAT(three.material_ranges,
                ElementsAre(MaterialRange{0, 1, std::nullopt}, MaterialRange{1, 1, 7U},
                            MaterialRange{2, 1, std::nullopt}));
}

TEST(MeshPart, IsEmptyWithoutTrianglesAndRefusesMissingOnes) {
    EXPECT_THAT(part_of(make_quad(), {}).positions, IsEmpty());
    const std::vector<std::uint32_t> beyond = {2};
    EXPECT_EQ(test::message_of<InvalidInput>([&] { part_of(make_quad(), beyond); }),
              "there is no triangle 2");
}

/// The error of directions after float matrices.
constexpr double placed_rounding = 1e-4;

Mesh framed(Mesh mesh, NormalMode normals) {
    Report report;
    return with_frames(std::move(mesh), {.normals = normals, .tangents = TangentMethod::mikktspace},
                       report)
        .mesh;
}

TEST(Placed, AMirrorTurnsTrianglesAndSigns) {
    const Mesh quad = framed(make_quad(), NormalMode::keep);
    const Mesh mirrored = transformed(quad, glm::scale(glm::mat4(1.0F), {-1.0F, 1.0F, 1.0F}));
    EXPECT_EQ(mirrored.positions[0], quad.positions[0] * glm::vec3(-1, 1, 1));
    EXPECT_EQ(mirrored.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(mirrored.tangents[0], glm::vec4(-1, 0, 0, -1)) << "bitangent y, as before";
    EXPECT_EQ(mirrored.triangles[0],
              glm::uvec3(quad.triangles[0].x, quad.triangles[0].z, quad.triangles[0].y));
}

TEST(Placed, NormalsStayPerpendicularUnderUnevenScale) {
    const Mesh sphere = framed(make_sphere(24, 12), NormalMode::keep);
    const Mesh ellipsoid = transformed(sphere, glm::scale(glm::mat4(1.0F), {3.0F, 1.0F, 0.5F}));
    for (std::size_t v = 0; v < sphere.positions.size(); ++v) {
        const glm::vec3 gradient = ellipsoid.positions[v] / glm::vec3(9.0F, 1.0F, 0.25F);
        EXPECT_LT(degrees_between(ellipsoid.normals[v], gradient), placed_rounding);
        EXPECT_NEAR(glm::dot(ellipsoid.normals[v], glm::vec3(ellipsoid.tangents[v])), 0.0F, 1e-5F);
        EXPECT_NEAR(glm::length(ellipsoid.normals[v]), 1.0F, 1e-6F);
    }
}

TEST(Placed, FramesAreThoseOfTheMovedMesh) {
    const Mesh torus = framed(make_torus(0.4F, 24, 12), NormalWeight::angle);
    for (const float mirror : {1.0F, -1.0F}) {
        const glm::mat4 turn = glm::rotate(glm::mat4(1.0F), 0.7F, glm::vec3(1.0F, 2.0F, 3.0F));
        const Mesh moved =
            transformed(torus, glm::scale(turn, glm::vec3(1e-6F, 1e-6F, mirror * 1e-6F)));
        Mesh again = moved;
        again.tangents.clear();
        again = framed(std::move(again), NormalWeight::angle);
        ASSERT_EQ(again.positions.size(), moved.positions.size());
        for (std::size_t v = 0; v < moved.positions.size(); ++v) {
            EXPECT_LT(degrees_between(moved.normals[v], again.normals[v]), 1e-3);
            EXPECT_LT(degrees_between(glm::vec3(moved.tangents[v]), glm::vec3(again.tangents[v])),
                      1e-2);
            ASSERT_EQ(moved.tangents[v].w, again.tangents[v].w);
        }
    }
}

TEST(Placed, NoDirectionIsLost) {
    const Mesh quad = framed(make_quad(), NormalMode::keep);
    const Mesh flat = transformed(quad, glm::scale(glm::mat4(1.0F), {0.0F, 1.0F, 1.0F}));
    EXPECT_EQ(flat.tangents[0], quad.tangents[0]);
    const Mesh nothing = transformed(quad, glm::mat4(0.0F));
    EXPECT_EQ(nothing.normals, quad.normals);
}

const std::vector<glm::uvec3> two_triangles = {{0, 1, 2}, {0, 2, 3}};

TEST(Split, EqualCornersSplitNothing) {
    const std::vector<glm::vec3> values(6, glm::vec3(0, 0, 1));
    const VertexSplit split = split_where_corners_differ(5, two_triangles, values);
    EXPECT_THAT(split.source_vertex, ElementsAre(0, 1, 2, 3, 4));
    EXPECT_EQ(split.triangles, two_triangles);
}

TEST(Split, OnlyVerticesWhoseCornersDifferAreSplit) {
    // Vertex 0 has different values in the triangles, vertex 2 has the same.
    const std::vector<glm::vec4> values = {{1, 0, 0, 1}, {2, 0, 0, 1}, {3, 0, 0, 1},
                                           {9, 0, 0, 1}, {3, 0, 0, 1}, {4, 0, 0, 1}};
    const VertexSplit split = split_where_corners_differ(4, two_triangles, values);
    EXPECT_THAT(split.source_vertex, ElementsAre(0, 1, 2, 3, 0));
    EXPECT_THAT(split.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(4, 2, 3)));
}

TEST(Split, EveryComponentCounts) {
    std::vector<glm::vec4> values(6, glm::vec4(1, 2, 3, 1));
    values[3].w = -1;
    EXPECT_EQ(split_where_corners_differ(4, two_triangles, values).source_vertex.size(), 5U);
}

TEST(Split, MinusZeroIsZeroAndAnEqualNaNIsEqual) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<glm::vec3> values(6, glm::vec3(0, nan, 1));
    values[3].x = -0.0F;
    EXPECT_EQ(split_where_corners_differ(4, two_triangles, values).source_vertex.size(), 4U);
    values[3].y = 0;
    EXPECT_EQ(split_where_corners_differ(4, two_triangles, values).source_vertex.size(), 5U);
}

TEST(Split, MakesOneCopyForEachFurtherValue) {
    // A fan of 30 triangles around vertex 0 with 5 different values there, and one value at every
    // other vertex.
    std::vector<glm::uvec3> triangles;
    std::vector<glm::vec3> values;
    for (std::uint32_t i = 0; i < 30; ++i) {
        triangles.emplace_back(0, i + 1, i + 2);
        values.insert(values.end(), {glm::vec3(i * 7 % 5, 0, 0), glm::vec3(0), glm::vec3(0)});
    }
    const VertexSplit split = split_where_corners_differ(32, triangles, values);
    EXPECT_EQ(split.source_vertex.size(), 36U);
    for (std::uint32_t i = 0; i < 30; ++i) {
        // The smallest value stays, and the others follow in ascending order.
        const std::uint32_t value = i * 7 % 5;
        EXPECT_EQ(split.triangles[i].x, value == 0 ? 0 : 31 + value);
    }
}

TEST(Split, TheVerticesDoNotDependOnTheOrderOfTriangles) {
    const Mesh mesh = test::sphere(12, 6);
    std::vector<glm::vec4> values;
    for (std::size_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner)
        values.emplace_back(corner * 31 % 4, 0, 0, 1);
    const auto order = test::shuffled(mesh.triangles.size());
    const VertexSplit split =
        split_where_corners_differ(mesh.positions.size(), mesh.triangles, values);
    const VertexSplit permuted = split_where_corners_differ(
        mesh.positions.size(), test::with_triangle_order(mesh, order).triangles,
        test::corners_in_order(values, order));
    EXPECT_EQ(permuted.source_vertex, split.source_vertex);
    for (std::size_t i = 0; i < order.size(); ++i)
        EXPECT_EQ(permuted.triangles[i], split.triangles[order[i]]);
}

TEST(Split, CarriesEveryAttributeAndKeepsTheRanges) {
    Mesh mesh = test::grid(1);
    mesh.name = "patch";
    for (std::size_t i = 0; i < 4; ++i)
        mesh.colors.emplace_back(i, 0, 0, 1);
    mesh.material_ranges = {{0, 1, 3}, {1, 1, 4}};
    std::vector<glm::vec3> values(6, glm::vec3(0, 0, 1));
    values[0] = {0, 0, 2};  // The first corner is at vertex 0.
    const VertexSplit split = split_where_corners_differ(4, mesh.triangles, values);
    const Mesh result = carried(mesh, split);
    ASSERT_EQ(result.positions.size(), 5U);
    EXPECT_EQ(result.name, "patch");
    EXPECT_EQ(result.positions[4], mesh.positions[0]);
    EXPECT_EQ(result.normals[4], mesh.normals[0]);
    EXPECT_EQ(result.texcoords[4], mesh.texcoords[0]);
    EXPECT_EQ(result.colors[4], mesh.colors[0]);
    EXPECT_TRUE(result.tangents.empty());
    EXPECT_EQ(result.material_ranges, mesh.material_ranges);
    EXPECT_NO_THROW(validate(result));
}

TEST(Split, WrongLengthsAndIndicesAreRefused) {
    const std::vector<glm::vec3> values(5);
    EXPECT_THAT([&] { split_where_corners_differ(4, two_triangles, values); },
                testing::ThrowsMessage<InvalidInput>(
                    testing::StrEq("there are 5 corner values, but 6 corners")));
    EXPECT_THROW(split_where_corners_differ(3, two_triangles, std::vector<glm::vec3>(6)),
                 InvalidInput);
}

/// Returns the volume of a closed mesh by the divergence theorem. It is negative if the mesh is
/// inside out.
double volume(const Mesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        sum +=
            glm::dot(glm::dvec3(mesh.positions[t.x]),
                     glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
            6.0;
    }
    return sum;
}

/// Returns the largest angle in degrees between a vertex normal and the normal of an adjacent
/// triangle.
double largest_tilt(const Mesh& mesh) {
    double largest = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 normal =
            glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        if (glm::length(normal) < 1e-9) continue;  // This triangle is at a pole.
        for (int k = 0; k < 3; ++k) {
            largest =
                std::max(largest, test::degrees_between(glm::dvec3(mesh.normals[t[k]]), normal));
        }
    }
    return largest;
}

TEST(Shapes, HaveTheirVolumesAndLookOutwards) {
    struct Case {
        Mesh mesh;
        double volume, tolerance, tilt;
    };
    // The volume of inscribed shapes is smaller by a share proportional to the square of the step.
    // Normals tilt by at most half a step, and on both sides of a quad together by a step.
    const double prism =
        64.0 * std::sin(2.0 * std::numbers::pi / 64.0);  // The areas of two 64-gons of radius 1.
    const Case cases[] = {
        {make_cube(), 8.0, 1e-9, 1e-4},
        {make_sphere(128, 64), 4.0 / 3.0 * std::numbers::pi, 0.01, 3.0},
        {make_torus(0.4F, 128, 64), 2.0 * std::numbers::pi * std::numbers::pi * 0.16, 0.01, 6.0},
        {make_cylinder(64), prism, 1e-5, 3.0},
    };
    for (const Case& shape : cases) {
        SCOPED_TRACE(shape.mesh.name);
        EXPECT_NO_THROW(validate(shape.mesh));
        EXPECT_NEAR(volume(shape.mesh), shape.volume, shape.tolerance);
        EXPECT_LT(largest_tilt(shape.mesh), shape.tilt);
        EXPECT_EQ(shape.mesh.texcoords.size(), shape.mesh.positions.size());
        for (const glm::vec3& normal : shape.mesh.normals)
            ASSERT_NEAR(glm::length(normal), 1.0F, 1e-6F);
    }
}

TEST(Shapes, AQuadFacesTheViewerWithTheImageUpright) {
    const Mesh quad = make_quad(2);
    EXPECT_EQ(quad.triangles.size(), 8U);
    EXPECT_EQ(quad.positions.front(), glm::vec3(-1, 1, 0));
    EXPECT_EQ(quad.texcoords.front(), glm::vec2(0, 0));
    EXPECT_EQ(quad.positions.back(), glm::vec3(1, -1, 0));
    EXPECT_EQ(quad.texcoords.back(), glm::vec2(1, 1));
    EXPECT_LT(largest_tilt(quad), 1e-6);
}

TEST(Shapes, MeetExactlyAtTheirSeams) {
    const Mesh torus = make_torus(0.3F, 8, 6);
    for (std::size_t side = 0; side <= 6; ++side)
        EXPECT_EQ(torus.positions[side * 9], torus.positions[side * 9 + 8]);
    for (std::size_t slice = 0; slice <= 8; ++slice)
        EXPECT_EQ(torus.positions[slice], torus.positions[6 * 9 + slice]);
}

TEST(Shapes, RefuseInvalidSizes) {
    EXPECT_THROW((void)make_quad(0), InvalidInput);
    EXPECT_THROW((void)make_sphere(2, 8), InvalidInput);
    EXPECT_THROW((void)make_sphere(8, 1), InvalidInput);
    EXPECT_THROW((void)make_torus(0.0F), InvalidInput);
    EXPECT_THROW((void)make_torus(0.4F, 5000, 8), InvalidInput);
    EXPECT_THROW((void)make_cylinder(2), InvalidInput);
}

}  // namespace
}  // namespace relief
