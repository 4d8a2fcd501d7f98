// SPDX-License-Identifier: Apache-2.0
// OFF: its kinds, polygons and damaged files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "mesh_text_test.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Off : public test::MeshTextTest {
  protected:
    Off() : MeshTextTest("a.off") {}
};

TEST_F(Off, PolygonsCommentsAndCountsBehindTheKeywordAreRead) {
    const Mesh mesh = read(
                          "OFF 5 2 0 # counts\n# nothing\n0 0 0\n1 0 nan\n\n1 1 0\n0 1 0\n9 9 9\n"
                          "4 0 1 2 3 255 0 0\n3 0 1 2")
                          .mesh;
    EXPECT_THAT(mesh.triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(0, 1, 2)));
    EXPECT_EQ(mesh.positions.size(), 5U);
    EXPECT_TRUE(std::isnan(mesh.positions[1].z));
}

TEST_F(Off, NormalsColorsAndTextureCoordinatesStandInThatOrder) {
    const Mesh mesh =
        read(
            "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 51 255 0.25 0.25\n1 0 0 0 0 1 1.0 0.5 0 0 1\n"
            "0 1 0 0 0 1 0 0 0 0 0 0\n3 0 1 2\n")
            .mesh;
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.texcoords[0], glm::vec2(0.25F, 0.75F));
    // The first line has a point in its texture coordinates only.
    EXPECT_EQ(mesh.colors[0], glm::vec4(1.0F, 0.0F, 0.2F, 1.0F));
    EXPECT_EQ(mesh.colors[1], glm::vec4(1.0F, 0.5F, 0.0F, 1.0F));
    EXPECT_EQ(mesh.colors[2], glm::vec4(0.0F));
}

TEST_F(Off, DamagedFilesAreRefused) {
    const std::string head = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_THAT(error_of(head + "3 0 1 3\n"), HasSubstr("face 0 names vertex 3"));
    EXPECT_THAT(error_of(head + "-5 0 1 2\n"), HasSubstr("a face has -5 corners"));
    EXPECT_THAT(error_of(head + "2000000000 0 1 2\n"), HasSubstr("a face has 2000000000 corners"));
    EXPECT_THAT(error_of(head + "3 0 1\n"), HasSubstr("the file ends"));
    EXPECT_THAT(error_of("OFF\n4000000000 1 0\n"), HasSubstr("too short for 4000000000 vertices"));
    EXPECT_THAT(error_of("4OFF\n1 1 0\n"), HasSubstr("'4OFF' is a kind that is not read"));
    EXPECT_THAT(error_of("OFF BINARY\n"), HasSubstr("vertex count"));
    EXPECT_THAT(error_of("solid\n"), HasSubstr("does not begin with 'OFF'"));
}

}  // namespace
}  // namespace relief
