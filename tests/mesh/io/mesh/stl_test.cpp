// SPDX-License-Identifier: Apache-2.0
// STL: ASCII and binary, welding by equal positions, damaged files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "mesh_text_test.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Stl : public test::MeshTextTest {
  protected:
    Stl() : MeshTextTest("a.stl") {}
};

std::string facet(const std::vector<glm::vec3>& corners) {
    std::string bytes(50, '\0');
    std::memcpy(bytes.data() + 12, corners.data(), 36);
    return bytes;
}

std::string binary(std::uint32_t count, const std::string& facets) {
    std::string bytes = "solid made by a tool that begins its binary files so";
    bytes.resize(84, ' ');
    std::memcpy(bytes.data() + 80, &count, 4);
    return bytes + facets;
}

TEST_F(Stl, CornersWithEqualPositionsBecomeOneVertex) {
    const Mesh mesh = read(binary(2, facet({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}) +
                                         facet({{0, 1, 0}, {1, 0, -0.0F}, {1, 1, 0}})))
                          .mesh;
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(2, 1, 3)));
    EXPECT_EQ(mesh.positions.size(), 4U);
}

TEST_F(Stl, TinyAndNonFiniteTrianglesAreKept) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Mesh mesh = read(binary(2, facet({{0, 0, 0}, {1e-40F, 0, 0}, {0, 1e-40F, 0}}) +
                                         facet({{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}})))
                          .mesh;
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(3, 4, 5)));
    EXPECT_TRUE(std::isnan(mesh.positions[3].x));
}

TEST_F(Stl, AsciiReadsAllSolidsInAnyCase) {
    const Mesh mesh = read(
                          "solid facet vertex\nFACET NORMAL a b c\nOuter Loop\nVertex 0 0 0\n"
                          "vertex 1 0 0\nvertex 0 1e0 0\nendloop endfacet\nendsolid x\nsolid "
                          "empty\nendsolid\nsolid\nfacet normal 0 0 1 outer loop vertex 0 0 0 "
                          "vertex 1 0 0 vertex 5 5 5 endloop endfacet endsolid")
                          .mesh;
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 1, 3)));
}

TEST_F(Stl, DamagedFilesAreRefusedAndSurplusIsCounted) {
    const std::string one = facet({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_THAT(error_of(binary(4000000000U, one)), HasSubstr("4000000000 triangles need"));
    EXPECT_THAT(error_of(binary(0, "")), HasSubstr("has no triangle"));
    EXPECT_THAT(error_of("solid\nfacet\nouter loop\nvertex 1,5 0 0\n"),
                HasSubstr("line 4: '1,5' stands where a number should be"));
    EXPECT_THAT(error_of("solid\nfacet outer loop vertex 0 0 0 vertex 1 1 1 endloop"),
                HasSubstr("line 2: a facet has 2 corners instead of 3"));
    EXPECT_THAT(error_of("solid\nfacet outer loop vertex 0 0 0"), HasSubstr("ends inside a facet"));
    EXPECT_EQ(read(binary(1, one + "trailing")).mesh.triangles.size(), 1U);
    EXPECT_EQ(report_.count("bytes behind the last triangle"), 1U);
}

TEST_F(Stl, TheAsciiAndTheBinaryFormOfAModelAgree) {
    RELIEF_NEEDS_SHARED(folder, "data/models/stl/assimp");
    const Mesh ascii = read_mesh(folder / "Spider_ascii.stl", report_).mesh;
    const Mesh binary = read_mesh(folder / "Spider_binary.stl", report_).mesh;
    EXPECT_EQ(ascii.triangles, binary.triangles);
    EXPECT_EQ(ascii.triangles.size(), 1368U);
}

}  // namespace
}  // namespace relief
