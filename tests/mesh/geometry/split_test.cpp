// SPDX-License-Identifier: Apache-2.0
// Splitting vertices by corner values: as few as possible, and carrying the rest along.
#include "relief/mesh/split.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "hard_meshes.h"
#include "relief/mesh/error.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::ElementsAre;

const std::vector<glm::uvec3> two_triangles = {{0, 1, 2}, {0, 2, 3}};

TEST(Split, EqualCornersSplitNothing) {
    const std::vector<glm::vec3> values(6, glm::vec3(0, 0, 1));
    const VertexSplit split = split_where_corners_differ(5, two_triangles, values);
    EXPECT_THAT(split.source_vertex, ElementsAre(0, 1, 2, 3, 4));
    EXPECT_EQ(split.triangles, two_triangles);
}

TEST(Split, OnlyVerticesWhoseCornersDifferAreSplit) {
    // Vertex 0 differs between the triangles, vertex 2 does not.
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
    // A fan of 30 triangles around vertex 0 with 5 different values there, one at each other.
    std::vector<glm::uvec3> triangles;
    std::vector<glm::vec3> values;
    for (std::uint32_t i = 0; i < 30; ++i) {
        triangles.emplace_back(0, i + 1, i + 2);
        values.insert(values.end(), {glm::vec3(i * 7 % 5, 0, 0), glm::vec3(0), glm::vec3(0)});
    }
    const VertexSplit split = split_where_corners_differ(32, triangles, values);
    EXPECT_EQ(split.source_vertex.size(), 36U);
    for (std::uint32_t i = 0; i < 30; ++i) {
        // The smallest value stays; the others follow in ascending order.
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

}  // namespace
}  // namespace relief
