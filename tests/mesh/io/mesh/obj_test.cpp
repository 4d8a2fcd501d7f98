// SPDX-License-Identifier: Apache-2.0
// OBJ and MTL: what is read, what is refused, and that what is written reads back bit for bit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "mesh_text_test.h"
#include "support/shapes.h"

namespace relief {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Obj : public test::MeshTextTest {
  protected:
    Obj() : MeshTextTest("a.obj") {}
};

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(Obj, CornersThatShareAllValuesBecomeOneVertexInOrderOfFirstUse) {
    const Mesh mesh = read(
                          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 1 0\n"
                          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                          "f 1/1 2/2 3/3\nf 1/1 5/3 4/4\nf 1/2 3/3 4/4\n")
                          .mesh;
    // Vertices 3 and 5 are equal; corner 1/2 is a fifth vertex.
    EXPECT_THAT(mesh.triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(4, 2, 3)));
    EXPECT_EQ(mesh.positions.size(), 5U);
    EXPECT_THAT(mesh.normals, IsEmpty());
}

/// More combinations at one position than are looked through one by one.
TEST_F(Obj, AFanWithANormalForEachFaceHasAVertexForEach) {
    std::string text = three;
    for (int i = 0; i < 100; ++i)
        text += fmt::format("vn {} 1 0\nf 1//{} 2//{} 3//1\n", i / 2, i + 1, i + 1);
    const Mesh mesh = read(text).mesh;
    // Normals come in pairs; the first face has the only corner at the third position.
    ASSERT_EQ(mesh.positions.size(), 101U);
    EXPECT_EQ(mesh.triangles[1], glm::uvec3(0, 1, 2));
    EXPECT_EQ(mesh.triangles[2], glm::uvec3(3, 4, 2));
    EXPECT_EQ(mesh.triangles[98], glm::uvec3(99, 100, 2));
    EXPECT_EQ(mesh.triangles[99], glm::uvec3(99, 100, 2));
    EXPECT_EQ(mesh.normals[99], glm::vec3(49, 1, 0));
}

TEST_F(Obj, TheTextureOriginMovesToTheUpperLeftCorner) {
    const Mesh mesh = read(three + "vt 0.25 0.125\nvt 1 1\nvt 0 0\nf 1/1 2/2 3/3\n").mesh;
    EXPECT_THAT(mesh.texcoords,
                ElementsAre(glm::vec2(0.25F, 0.875F), glm::vec2(1, 0), glm::vec2(0, 1)));
}

TEST_F(Obj, NegativeIndicesCountBackFromWhereTheyStand) {
    const Mesh mesh = read(three + "f -3 -2 -1\nv 5 5 5\nf -4 -3 -1\n").mesh;
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 1, 3)));
    EXPECT_EQ(mesh.positions[3], glm::vec3(5.0F));
}

TEST_F(Obj, EveryLineEndingContinuationAndNumberFormatIsRead) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const Mesh mesh =
            read("\xEF\xBB\xBF# comment \\" + end + "v +1e2 .5 -5." + end + "v 1 0 0 # aside" +
                 end + " \tv\t0 1 \\" + end + " 7" + end + "f 1 \\" + end + "2 3")
                .mesh;
        EXPECT_EQ(mesh.positions[0], glm::vec3(100.0F, 0.5F, -5.0F));
        EXPECT_EQ(mesh.positions[2], glm::vec3(0.0F, 1.0F, 7.0F));
        EXPECT_EQ(mesh.triangles.size(), 1U);
    }
    EXPECT_TRUE(report_.empty());
}

TEST_F(Obj, NonFiniteNumbersAreKept) {
    const Mesh mesh = read("v nan 1.#QNAN -inf\nv 1e99 1e-60 -1.#INF\nv 0 0 0\nf 1 2 3\n").mesh;
    EXPECT_TRUE(std::isnan(mesh.positions[0].x));
    EXPECT_TRUE(std::isnan(mesh.positions[0].y));
    EXPECT_EQ(mesh.positions[0].z, -std::numeric_limits<float>::infinity());
    EXPECT_EQ(mesh.positions[1].x, std::numeric_limits<float>::infinity());
    EXPECT_EQ(mesh.positions[1].y, 0.0F);
    EXPECT_EQ(mesh.positions[1].z, -std::numeric_limits<float>::infinity());
}

TEST_F(Obj, APolygonOfAThousandCornersIsCutAndLeavesLaterFacesAlone) {
    std::string text;
    std::string face = "f";
    for (int i = 0; i < 1000; ++i) {
        const double angle = i * 0.00628318;
        text += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    const Mesh mesh = read(text + face + "\nf 7 8 9\n").mesh;
    ASSERT_EQ(mesh.triangles.size(), 999U);
    EXPECT_EQ(mesh.triangles.back(), glm::uvec3(6, 7, 8));
}

TEST_F(Obj, ColorsStandBehindPositions) {
    const Mesh mesh = read("v 0 0 0\nv 1 0 0 0.25 0.5 0.75\nv 0 1 0 1 0 0 0.5\nf 1 2 3\n").mesh;
    EXPECT_THAT(mesh.colors, ElementsAre(glm::vec4(1.0F), glm::vec4(0.25F, 0.5F, 0.75F, 1.0F),
                                         glm::vec4(1, 0, 0, 0.5F)));
}

TEST_F(Obj, WhatSomeCornersLackIsFilledInAndCounted) {
    const Mesh mesh =
        read("v 0 0 0\nv 0 1 0\nv 0 0 1\nvt 0.5 0.5\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1 2 3\n")
            .mesh;
    ASSERT_EQ(mesh.positions.size(), 6U);
    EXPECT_EQ(mesh.normals[3], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.texcoords[3], glm::vec2(0.0F));
    EXPECT_EQ(report_.count("corner without a normal"), 3U);
    EXPECT_EQ(report_.count("corner without texture coordinates"), 3U);
}

TEST_F(Obj, WhatIsLeftOutIsCounted) {
    read(three +
         "p 1\nl 1 2\nl 2 3\nf 1 2\nf 1 2 3\ncurv 0 1 1 2\nfoo\nf 1/9 2/9 3/9\ns 1\ng a b\n");
    EXPECT_EQ(report_.count("point"), 1U);
    EXPECT_EQ(report_.count("line"), 2U);
    EXPECT_EQ(report_.count("face of fewer than three corners"), 1U);
    EXPECT_EQ(report_.count("free-form geometry"), 1U);
    EXPECT_EQ(report_.count("unknown statement"), 1U);
    EXPECT_EQ(report_.count("texture coordinate that does not exist"), 3U);
    EXPECT_EQ(report_.findings().size(), 6U);
}

TEST_F(Obj, WhatCannotBeReadIsRefusedByLineAndValue) {
    EXPECT_THAT(error_of(three + "f 1 2 4\n"),
                HasSubstr("a.obj: face 1 names vertex 4, but there are only 3"));
    EXPECT_THAT(error_of(three + "f 1 2 0\n"), HasSubstr("line 4: vertex 0 is named"));
    EXPECT_THAT(error_of(three + "f 1 2 -4\n"), HasSubstr("line 4: vertex -4 is named"));
    EXPECT_THAT(error_of(three + "f 1 2 99999999999\n"), HasSubstr("line 4: vertex 99999999999"));
    EXPECT_THAT(error_of("v 0 x 0\n"), HasSubstr("line 1: 'x' is not a number"));
    EXPECT_THAT(error_of("v 0 1\n"), HasSubstr("line 1: a vertex has 2 coordinates"));
    EXPECT_THAT(error_of(three + "f 1/1/1/1 2 3\n"), HasSubstr("line 4: a corner ends in '/1'"));
    EXPECT_THAT(error_of(three), HasSubstr("has no triangle"));
    EXPECT_THAT(error_of(""), HasSubstr("has no triangle"));
    EXPECT_THAT(error_of(std::string("\xFF\xFEv\0 \0", 6)), HasSubstr("UTF-16"));
}

TEST_F(Obj, TrianglesAreGroupedByMaterialInOrderOfFirstUse) {
    write("m.mtl",
          "newmtl red\nKd 1 0 0\nNs 50\nd 0.5\nmap_Kd tex\\a b.png\nmap_Bump -bm 0.25 h.png\n"
          "norm n.png\nKe 0 2 0\nillum 3\nNi 1.5\nmap_Ks s.png\nmap_d d.png\nmap_Ka amb.png\n"
          "newmtl plain\nmap_Kd -s 2 2 2 -o 0.5 0 0 a.png\nmap_Ka a.png\n");
    const MeshFile file = read(three +
                               "mtllib m.mtl\nf 1 2 3\nusemtl red\nf 2 3 1\nusemtl other\nf 3 1 2\n"
                               "usemtl red\nf 1 3 2\nusemtl plain\nf 1 3 2\n");
    EXPECT_THAT(file.mesh.material_ranges,
                ElementsAre(MaterialRange{0, 1, std::nullopt}, MaterialRange{1, 2, 0U},
                            MaterialRange{3, 1, 1U}, MaterialRange{4, 1, 2U}));
    EXPECT_THAT(file.mesh.triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(1, 2, 0), glm::uvec3(0, 2, 1),
                            glm::uvec3(2, 0, 1), glm::uvec3(0, 2, 1)));
    ASSERT_EQ(file.materials.size(), 3U);
    const MtlMaterial& red = file.materials[0];
    EXPECT_EQ(red.name, "red");
    EXPECT_EQ(red.diffuse, glm::vec3(1, 0, 0));
    EXPECT_EQ(red.emission, glm::vec3(0, 2, 0));
    EXPECT_EQ(red.shininess, 50.0F);
    EXPECT_EQ(red.opacity, 0.5F);
    EXPECT_EQ(red.illumination_model, 3);
    EXPECT_EQ(red.diffuse_map, folder_ / "tex/a b.png");
    EXPECT_EQ(red.normal_map, folder_ / "n.png");
    EXPECT_EQ(red.bump_map, folder_ / "h.png");
    EXPECT_EQ(red.bump_strength, 0.25F);
    EXPECT_EQ(red.refractive_index, 1.5F);
    EXPECT_EQ(red.specular_map, folder_ / "s.png");
    EXPECT_EQ(red.opacity_map, folder_ / "d.png");
    EXPECT_THAT(red.more, ElementsAre("map_Ka"));
    EXPECT_EQ(file.materials[1].name, "other");
    EXPECT_EQ(file.materials[2].illumination_model, 2);  // MTL says nothing, and 0 is no light.
    EXPECT_THAT(file.materials[2].more, ElementsAre("-s", "-o"));
    EXPECT_EQ(report_.count("unknown material"), 1U);
}

TEST_F(Obj, SmoothingGroupsGoWithTheirTrianglesAndComeBack) {
    const std::string text = three +
                             "v 1 1 0\nf 1 2 3\ns 4\nusemtl B\nf 1 2 4 3\nusemtl A\ns off\n"
                             "f 1 2 3\ns on\nf 2 3 4\nusemtl B\ns 4294967295\nf 1 2 3\n";
    const MeshFile first = read(text);
    // By material: none; B with its quad and its last; A.
    EXPECT_THAT(first.mesh.smoothing_groups, ElementsAre(0U, 4U, 4U, 4294967295U, 0U, 1U));
    write_mesh(folder_ / "b.obj", first);
    EXPECT_EQ(read_mesh(folder_ / "b.obj", report_).mesh.smoothing_groups,
              first.mesh.smoothing_groups);
    EXPECT_THAT(read(three + "f 1 2 3\n").mesh.smoothing_groups, IsEmpty());
}

TEST_F(Obj, ASmoothingGroupThatIsNoNumberIsOffAndCounted) {
    for (const char* group : {"seven", "-1", "1.5", "", "4294967296"}) {
        const Mesh mesh = read(three + "s " + group + "\nf 1 2 3\n").mesh;
        EXPECT_THAT(mesh.smoothing_groups, ElementsAre(0U)) << group;
        EXPECT_EQ(report_.count("smoothing group that is no number"), 1U) << group;
        report_ = {};
    }
}

TEST_F(Obj, AMissingMtlFileIsCountedAndNamesSurvive) {
    const MeshFile file = read(three + "mtllib nowhere.mtl\nusemtl steel\nf 1 2 3\n");
    EXPECT_EQ(report_.count("unreadable MTL file"), 1U);
    ASSERT_EQ(file.materials.size(), 1U);
    EXPECT_EQ(file.materials[0].name, "steel");
}

TEST_F(Obj, FloatsOfEveryMagnitudeComeBackBitForBit) {
    std::mt19937 random(7);
    MeshFile contents;
    for (int i = 0; i < 30'000; ++i) {
        const auto any_float = [&] {
            for (;;) {
                const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
                if (!std::isnan(value)) return value;  // NaN keeps no payload in text.
            }
        };
        const float v = static_cast<float>(random()) / 4294967296.0F;
        contents.mesh.positions.emplace_back(any_float(), any_float(), any_float());
        contents.mesh.normals.emplace_back(any_float(), any_float(), any_float());
        // |v| >= 2e-9 turns and comes back exactly, as obj_writer.cpp says.
        contents.mesh.texcoords.emplace_back(any_float(), i % 2 == 0 ? v : 3.0F * v - 1.0F);
        contents.mesh.colors.emplace_back(any_float(), any_float(), any_float(), any_float());
    }
    for (std::uint32_t i = 0; i < 30'000; i += 3) {
        contents.mesh.triangles.emplace_back(i, i + 1, i + 2);
    }
    write_mesh(folder_ / "b.obj", contents);
    const Mesh read = read_mesh(folder_ / "b.obj", report_).mesh;
    EXPECT_EQ(read.triangles, contents.mesh.triangles);
    EXPECT_EQ(read.positions, contents.mesh.positions);
    EXPECT_EQ(read.normals, contents.mesh.normals);
    EXPECT_EQ(read.texcoords, contents.mesh.texcoords);
    EXPECT_EQ(read.colors, contents.mesh.colors);
}

TEST_F(Obj, MaterialsComeBack) {
    MeshFile contents{test::cube(), {}};
    contents.mesh.material_ranges = {{0, 4, 1U}, {4, 2, std::nullopt}, {6, 6, 0U}};
    contents.materials.resize(2);
    contents.materials[0].name = "with blank";
    contents.materials[0].diffuse_map = folder_ / "a b.png";
    contents.materials[0].bump_map = folder_ / "sub/h.png";
    contents.materials[0].bump_strength = 2.5F;
    contents.materials[0].specular_map = folder_ / "s.png";
    contents.materials[0].opacity_map = folder_ / "d.png";
    contents.materials[0].refractive_index = 1.5F;
    contents.materials[1].name = "with blank";  // The same: names are made different.
    contents.materials[1].emission = glm::vec3(0.1F, 0.2F, 0.3F);
    write_mesh(folder_ / "c.obj", contents);
    const MeshFile read = read_mesh(folder_ / "c.obj", report_);
    EXPECT_THAT(read.mesh.material_ranges,
                ElementsAre(MaterialRange{0, 2, std::nullopt}, MaterialRange{2, 4, 0U},
                            MaterialRange{6, 6, 1U}));
    EXPECT_EQ(read.materials[0].name, "with_blank_2");
    EXPECT_EQ(read.materials[0].emission, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(read.materials[1].name, "with_blank");
    EXPECT_EQ(read.materials[1].diffuse_map, folder_ / "a b.png");
    EXPECT_EQ(read.materials[1].bump_map, folder_ / "sub/h.png");
    EXPECT_EQ(read.materials[1].bump_strength, 2.5F);
    EXPECT_EQ(read.materials[1].specular_map, folder_ / "s.png");
    EXPECT_EQ(read.materials[1].opacity_map, folder_ / "d.png");
    EXPECT_EQ(read.materials[1].refractive_index, 1.5F);
    EXPECT_EQ(read.materials[0].refractive_index, 1.0F);
    EXPECT_TRUE(report_.empty());
}

TEST_F(Obj, RealFilesHaveTheCountsOfTheirLists) {
    RELIEF_NEEDS_SHARED(objects, "data/models/obj");
    struct Expected {
        const char* file;
        std::size_t triangles, vertices;
    };
    // Triangles as the data's own list has them; vertices of spot counted as distinct v/vt pairs.
    for (const Expected& expected : {Expected{"spot/spot_triangulated.obj", 5856, 3225},
                                     {"spot/spot_quadrangulated.obj", 5856, 3225},
                                     {"scorpion.obj", 99990, 49997},
                                     {"pirate.obj", 5010, 3152},
                                     {"teapot.obj", 6320, 3325}}) {
        const Mesh mesh = read_mesh(objects / expected.file, report_).mesh;
        EXPECT_EQ(mesh.triangles.size(), expected.triangles) << expected.file;
        EXPECT_EQ(mesh.positions.size(), expected.vertices) << expected.file;
    }
}

}  // namespace
}  // namespace relief
