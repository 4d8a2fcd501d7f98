// SPDX-License-Identifier: Apache-2.0
// What makes a mesh valid, what the error says, and bounds.
#include "relief/mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/check_triangles.h"
#include "relief/mesh/error.h"
#include "support/shapes.h"

namespace relief {
namespace {

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
    expect_invalid(mesh, "there are 2 colours, but 4 positions");
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
    // Such a mesh takes 17 GB, so there is only one triangle of it to look at; nobody may.
    const glm::uvec3 triangle(0, 0, 0);
    const std::span<const glm::uvec3> too_many(&triangle, 1'431'655'766);
    EXPECT_THAT([&] { check_triangles(too_many, 1); },
                testing::ThrowsMessage<InvalidInput>(
                    StrEq("there are 1431655766 triangles, but no more than 1431655765 can be "
                          "numbered")));
}

TEST(Mesh, BoundsLeaveOutWhatIsNotFinite) {
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

}  // namespace
}  // namespace relief
