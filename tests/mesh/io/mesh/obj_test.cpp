// SPDX-License-Identifier: Apache-2.0
// OBJ and MTL files: statements, materials, objects, writing, and parsing in pieces, which must not
// change the result.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "io/mesh/obj_parser.h"
#include "mesh/io/mesh/mesh_files.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Obj : public test::MeshTextTest {
  protected:
    Obj() : MeshTextTest("a.obj") {}
};

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(Obj, EqualCornersBecomeOneVertexInOrderOfFirstUse) {
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

/// One position has more combinations than a linear search covers.
TEST_F(Obj, AFanWithANormalForEachFaceHasAVertexForEach) {
    std::string text = three;
    for (int i = 0; i < 100; ++i)
        text += fmt::format("vn {} 1 0\nf 1//{} 2//{} 3//1\n", i / 2, i + 1, i + 1);
    const Mesh mesh = read(text).mesh;
    // Normals come in pairs. The first face has the only corner at the third position.
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

TEST_F(Obj, NegativeIndicesAreRelativeToTheirLine) {
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

TEST_F(Obj, ColorsFollowPositions) {
    const Mesh mesh = read("v 0 0 0\nv 1 0 0 0.25 0.5 0.75\nv 0 1 0 1 0 0 0.5\nf 1 2 3\n").mesh;
    EXPECT_THAT(mesh.colors, ElementsAre(glm::vec4(1.0F), glm::vec4(0.25F, 0.5F, 0.75F, 1.0F),
                                         glm::vec4(1, 0, 0, 0.5F)));
}

TEST_F(Obj, MissingCornerAttributesAreFilledAndCounted) {
    const Mesh mesh =
        read("v 0 0 0\nv 0 1 0\nv 0 0 1\nvt 0.5 0.5\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1 2 3\n")
            .mesh;
    ASSERT_EQ(mesh.positions.size(), 6U);
    EXPECT_EQ(mesh.normals[3], glm::vec3(1, 0, 0));
    EXPECT_EQ(mesh.texcoords[3], glm::vec2(0.0F));
    EXPECT_EQ(report_.count("corner without a normal"), 3U);
    EXPECT_EQ(report_.count("corner without texture coordinates"), 3U);
}

TEST_F(Obj, CountsOmittedStatements) {
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

TEST_F(Obj, ErrorsHaveLineAndValue) {
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
    EXPECT_EQ(file.materials[2].illumination_model, 2);  // MTL has no statement, and 0 means unlit.
    EXPECT_THAT(file.materials[2].more, ElementsAre("-s", "-o"));
    EXPECT_EQ(report_.count("unknown material"), 1U);
}

TEST_F(Obj, SmoothingGroupsGoWithTheirTrianglesAndComeBack) {
    const std::string text = three +
                             "v 1 1 0\nf 1 2 3\ns 4\nusemtl B\nf 1 2 4 3\nusemtl A\ns off\n"
                             "f 1 2 3\ns on\nf 2 3 4\nusemtl B\ns 4294967295\nf 1 2 3\n";
    const MeshFile first = read(text);
    // By material: none; B with its quad and its last triangle; A.
    EXPECT_THAT(first.mesh.smoothing_groups, ElementsAre(0U, 4U, 4U, 4294967295U, 0U, 1U));
    write_mesh(folder_ / "b.obj", first);
    EXPECT_EQ(read_mesh(folder_ / "b.obj", report_).mesh.smoothing_groups,
              first.mesh.smoothing_groups);
    EXPECT_THAT(read(three + "f 1 2 3\n").mesh.smoothing_groups, IsEmpty());
}

TEST_F(Obj, InvalidSmoothingGroupIsOffAndCounted) {
    for (const char* group : {"seven", "-1", "1.5", "", "4294967296"}) {
        const Mesh mesh = read(three + "s " + group + "\nf 1 2 3\n").mesh;
        EXPECT_THAT(mesh.smoothing_groups, ElementsAre(0U)) << group;
        EXPECT_EQ(report_.count("smoothing group that is not a number"), 1U) << group;
        report_ = {};
    }
}

TEST_F(Obj, AMissingMtlFileIsCountedAndNamesSurvive) {
    const MeshFile file = read(three + "mtllib nowhere.mtl\nusemtl steel\nf 1 2 3\n");
    EXPECT_EQ(report_.count("unreadable MTL file"), 1U);
    ASSERT_EQ(file.materials.size(), 1U);
    EXPECT_EQ(file.materials[0].name, "steel");
}

TEST_F(Obj, NamesInLatin1BecomeUtf8) {
    write("m.mtl",
          "newmtl Stra\xDF"
          "e\nKd 1 0 0\n");
    const MeshFile file = read("mtllib m.mtl\no Geb\xE4ude\n" + three +
                               "usemtl Stra\xDF"
                               "e\nf 1 2 3\no \xC3\xA4\nf 3 2 1\n");
    EXPECT_THAT(file.objects, ElementsAre("Geb\xC3\xA4ude", "\xC3\xA4"));
    ASSERT_EQ(file.materials.size(), 1U);
    EXPECT_EQ(file.materials[0].name,
              "Stra\xC3\x9F"
              "e");
    EXPECT_EQ(file.materials[0].diffuse, glm::vec3(1, 0, 0));
    EXPECT_EQ(report_.count("name that is not UTF-8"), 2U);
    // A second form of '/', a surrogate, a code above U+10FFFF and a cut character are not UTF-8.
    for (const char* name : {"\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "a\xE2\x82"}) {
        report_ = {};
        read(std::string("o ") + name + "\n" + three + "f 1 2 3\n");
        EXPECT_EQ(report_.count("name that is not UTF-8"), 2U) << "of the mesh and of its object";
    }
    report_ = {};
    read("o \xE2\x82\xAC \xF0\x9F\x98\x80\n" + three + "f 1 2 3\n");
    EXPECT_TRUE(report_.empty());
}

TEST_F(Obj, ColorsThatAreNotFiniteAreWhite) {
    const MeshFile file = read("v 0 0 0 0.5 nan 0\nv 1 0 0 1 0 0\nv 0 1 0 inf 0 0\nf 1 2 3\n");
    EXPECT_THAT(file.mesh.colors, ElementsAre(glm::vec4(1), glm::vec4(1, 0, 0, 1), glm::vec4(1)));
    EXPECT_EQ(report_.count("non-finite color"), 2U);
}

TEST_F(Obj, FloatsOfEveryMagnitudeComeBackBitForBit) {
    std::mt19937 random(7);
    MeshFile contents;
    for (int i = 0; i < 30'000; ++i) {
        const auto any_float = [&] {
            for (;;) {
                const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
                if (!std::isnan(value)) return value;  // Text does not keep the payload of a NaN.
            }
        };
        const float v = static_cast<float>(random()) / 4294967296.0F;
        contents.mesh.positions.emplace_back(any_float(), any_float(), any_float());
        contents.mesh.normals.emplace_back(any_float(), any_float(), any_float());
        // |v| >= 2e-9 is flipped and comes back exactly, as obj_file.cpp explains.
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
    contents.mesh.name = "two\nlines\\";
    contents.materials[1].name = "with blank";  // Equal names become different.
    contents.materials[1].emission = glm::vec3(0.1F, 0.2F, 0.3F);
    Report names;
    write_mesh(folder_ / "c.obj", contents, names);
    ASSERT_EQ(names.findings().size(), 2U);
    EXPECT_EQ(names.findings()[0].first, (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(names.count("mesh name that OBJ cannot store"), 1U);
    const MeshFile read = read_mesh(folder_ / "c.obj", report_);
    EXPECT_THAT(read.mesh.material_ranges,
                ElementsAre(MaterialRange{0, 2, std::nullopt}, MaterialRange{2, 4, 0U},
                            MaterialRange{6, 6, 1U}));
    EXPECT_EQ(read.mesh.name, "two_lines_");
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

TEST_F(Obj, NumbersDoNotDependOnTheLocaleOfTheProcess) {
    const std::string make =
        "localedef -i de_DE -f ISO-8859-1 " + (folder_ / "de_DE").string() + " 2>/dev/null";
    if (std::system(make.c_str()) != 0)
        GTEST_SKIP() << "needs localedef and de_DE (Debian: locales)";
    ASSERT_EQ(::setenv("LOCPATH", folder_.path().c_str(), 1), 0);
    ASSERT_NE(std::setlocale(LC_ALL, "de_DE"), nullptr);
    ASSERT_STREQ(std::localeconv()->decimal_point, ",");
    write("m.mtl", "newmtl a\nKd 0.25 0.5 0.75\nNs 12.5\nd 0.5\nmap_Bump -bm 0.5 b.png\n");
    const MeshFile file =
        read("mtllib m.mtl\nv 1.5e-50 0.5 -2.5e50\nv 1.25 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    write_mesh(folder_ / "b.obj", file);
    const MeshFile back = read_mesh(folder_ / "b.obj", report_);
    std::setlocale(LC_ALL, "C");
    ::unsetenv("LOCPATH");
    constexpr float infinity = std::numeric_limits<float>::infinity();
    EXPECT_THAT(file.mesh.positions, ElementsAre(glm::vec3(0, 0.5F, -infinity),
                                                 glm::vec3(1.25F, 0, 0), glm::vec3(0, 1, 0)));
    EXPECT_EQ(back.mesh.positions, file.mesh.positions);
    for (const MeshFile* one : {&file, &back}) {
        const MtlMaterial& material = one->materials.at(0);
        EXPECT_EQ(material.diffuse, glm::vec3(0.25F, 0.5F, 0.75F));
        EXPECT_EQ(material.shininess, 12.5F);
        EXPECT_EQ(material.opacity, 0.5F);
        EXPECT_EQ(material.bump_strength, 0.5F);
    }
}

TEST_F(Obj, AnMtlFileThatWasReadIsNotReplacedByThatOfAnotherObjFile) {
    write("m.mtl", "newmtl a\nnewmtl unused\n");
    const MeshFile file = read("mtllib m.mtl\n" + three + "usemtl a\nf 1 2 3\n");
    EXPECT_EQ(message_of<FileError>([&] { write_mesh(folder_ / "m.obj", file); }),
              fmt::format("{}: has the materials of {}; use another name",
                          (folder_ / "m.mtl").string(), (folder_ / "a.obj").string()));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "m.obj"));
    EXPECT_EQ(std::filesystem::file_size(folder_ / "m.mtl"), 23U);
    for (int i = 0; i < 2; ++i) {  // The second time, a.mtl is read and replaced.
        const MeshFile back = read_mesh(folder_ / "a.obj", report_);
        EXPECT_THAT(back.sources,
                    ElementsAre(folder_ / "a.obj", folder_ / (i == 0 ? "m.mtl" : "a.mtl")));
        write_mesh(folder_ / "a.obj", back);
    }
}

TEST_F(Obj, NamesOfImagesComeBackOrAreRefused) {
    MeshFile contents{test::cube(), {}};
    contents.materials.resize(1);
    contents.mesh.material_ranges = {{0, 12, 0}};
    for (const char* name : {"a b.png", "#.png", "a #b.png", "-bm 2.png", "-s.png", "a\"b.png",
                             "\xE4.png", "'.png", "a\tb.png", "\x1B.png", "1", "-clamp on"}) {
        contents.materials[0].diffuse_map = folder_ / name;
        contents.materials[0].bump_map = folder_ / name;
        write_mesh(folder_ / "d.obj", contents);
        const MtlMaterial back = read_mesh(folder_ / "d.obj", report_).materials.at(0);
        EXPECT_EQ(back.diffuse_map, folder_ / name) << name;
        EXPECT_EQ(back.bump_map, folder_ / name) << name;
    }
    std::filesystem::remove(folder_ / "d.obj");
    for (const char* name :
         {"a\nnewmtl b.png", "a\rb.png", " a.png", "a.png ", "\ta", "a\\b.png"}) {
        contents.materials[0].diffuse_map = folder_ / name;
        EXPECT_THAT(message_of<FileError>([&] { write_mesh(folder_ / "d.obj", contents); }),
                    HasSubstr(std::string("d.mtl: cannot name the file '") + name + "'"));
    }
    contents.materials[0].diffuse_map = folder_ / "a.png";
    EXPECT_THROW(write_mesh(folder_ / "d\nf 1 2 3.obj", contents), FileError);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "d.obj")) << "nothing is written";
}

TEST_F(Obj, RealFilesHaveTheCountsOfTheirLists) {
    RELIEF_NEEDS_SHARED(objects, "data/models/obj");
    struct Expected {
        const char* file;
        std::size_t triangles, vertices;
    };
    // The triangle counts of the data's list; vertices of spot are distinct v/vt pairs.
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

/// The faces of a file are triangles over the same three vertices.
MeshFile read(const std::string& statements) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path file = folder / "some.obj";
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\n" << statements;
    Report report;
    return read_mesh(file, report);
}

TEST(ObjObjects, FollowOStatements) {
    const MeshFile file = read(
        "f 1 2 3\no bolt high\ng left\nf 1 2 3\nf 2 3 1\no none\no nut\nf 1 2 3\n"
        "o bolt high\nf 3 2 1\n");
    EXPECT_THAT(file.objects, ElementsAre("", "bolt high", "nut"));
    EXPECT_THAT(file.object_of, ElementsAre(0, 1, 1, 2, 1));
}

TEST(ObjObjects, AreGroupsElse) {
    const MeshFile file = read("g a b\nf 1 2 3\ng c\nf 1 2 3\n");
    EXPECT_THAT(file.objects, ElementsAre("a b", "c"));
    EXPECT_THAT(file.object_of, ElementsAre(0, 1));
    EXPECT_THAT(read("f 1 2 3\n").objects, IsEmpty());
    const MeshFile one = read("o only\ng a\nf 1 2 3\ng b\nf 1 2 3\n");
    EXPECT_THAT(one.objects, ElementsAre("only"));
    EXPECT_THAT(one.object_of, IsEmpty());
}

TEST(ObjObjects, GoWithTheirTrianglesWhenTheseAreGroupedByMaterialAndCut) {
    const MeshFile file = read(
        "v 1 1 0\no a\nusemtl red\nf 1 2 4 3\nusemtl blue\nf 1 2 3\no b\nusemtl red\nf 1 2 3\n");
    EXPECT_THAT(file.object_of, ElementsAre(0, 0, 1, 0));
}

constexpr std::size_t whole = 1 << 20;

/// Every statement that affects later ones, with given faces in between.
std::string every_statement(const std::string& face) {
    std::string text = "o first\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (int i = 0; i < 40; ++i) {
        text += fmt::format("v {} {}.5 -1e-3{}\r\n", i, i, i > 20 ? " 0.5 0.25 1" : "");
        text += fmt::format("vt 0.{} 0.5\nvn 0 0 1\n", i);
        if (i % 9 == 4) text += fmt::format("usemtl m{}\n", i % 4);
        if (i % 7 == 3) text += fmt::format("s {}\n", i % 5 == 0 ? std::string("off") : "3");
        if (i == 25) text += "mtllib b.mtl\nl 1 2\nnonsense 1\ns strange\n";
        text += "f -1/-1/-1 -2/-1/-1 \\\n  1/1/1\n# no line goes on here \\\n";
        text += i % 3 == 0 ? "f 1 2\n" : "f 1//1 2//1 3//1 -1//-1\n";
        if (i % 11 == 0) text += face;
    }
    for (int i = 43; i < 60; ++i)
        text += "v 9 9 9\n";
    return text;
}

struct Outcome {
    ObjStatements statements;
    Report report;
    std::string error;
};

Outcome parsed(const std::string& text, std::size_t piece_size) {
    Outcome outcome;
    try {
        outcome.statements = parse_obj(text, "a.obj", glm::dvec3(0.0), outcome.report, piece_size);
    } catch (const FileError& error) {
        outcome.error = error.what();
    }
    return outcome;
}

void expect_equal(const ObjStatements& a, const ObjStatements& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.colors, b.colors);
    EXPECT_EQ(a.texcoords, b.texcoords);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.has_smoothing_groups, b.has_smoothing_groups);
    EXPECT_EQ(a.materials, b.materials);
    EXPECT_EQ(a.material_libraries, b.material_libraries);
    ASSERT_EQ(a.corners.size(), b.corners.size());
    for (std::size_t i = 0; i < a.corners.size(); ++i) {
        EXPECT_EQ(a.corners[i].position, b.corners[i].position) << i;
        EXPECT_EQ(a.corners[i].texcoord, b.corners[i].texcoord) << i;
        EXPECT_EQ(a.corners[i].normal, b.corners[i].normal) << i;
    }
    ASSERT_EQ(a.faces.size(), b.faces.size());
    for (std::size_t i = 0; i < a.faces.size(); ++i) {
        EXPECT_EQ(a.faces[i].first_corner, b.faces[i].first_corner) << i;
        EXPECT_EQ(a.faces[i].corner_count, b.faces[i].corner_count) << i;
        EXPECT_EQ(a.faces[i].material, b.faces[i].material) << i;
        EXPECT_EQ(a.faces[i].smoothing_group, b.faces[i].smoothing_group) << i;
    }
}

TEST(ObjPieces, SayTheSameInAnySize) {
    const std::string text = every_statement("f 1/4000000 1 2\n");
    const Outcome once = parsed(text, whole);
    ASSERT_EQ(once.error, "");
    ASSERT_EQ(once.statements.positions.size(), 60U);
    EXPECT_EQ(once.statements.colors.size(), 60U);
    EXPECT_EQ(once.statements.materials, (std::vector<std::string>{"m0", "m1", "m2", "m3"}));
    EXPECT_EQ(once.statements.name, "first");
    EXPECT_EQ(once.report.count("texture coordinate that does not exist"), 4U);
    EXPECT_EQ(once.report.count("face of fewer than three corners"), 14U);
    for (const std::size_t size : {1U, 5U, 20U, 64U, 300U, 1000U}) {
        const Outcome pieces = parsed(text, size);
        EXPECT_EQ(pieces.error, "");
        expect_equal(pieces.statements, once.statements);
        ASSERT_EQ(pieces.report.findings().size(), once.report.findings().size());
        for (std::size_t i = 0; i < once.report.findings().size(); ++i)
            EXPECT_EQ(pieces.report.findings()[i], once.report.findings()[i]) << size;
    }
}

TEST(ObjPieces, HaveNoNameWithSeveralObjects) {
    const std::string there = every_statement("f 4 1 2\n") + "o second\nf 1 2 3\n";
    EXPECT_EQ(parsed(there, whole).error, "");
    EXPECT_EQ(parsed(there, whole).statements.name, "");
    EXPECT_EQ(parsed(there, 100).statements.name, "");
}

TEST(ObjPieces, HaveTheSameErrors) {
    const std::string text = every_statement("f 4000000/3 1 2\n");
    EXPECT_EQ(parsed(text, whole).error, parsed(text, 100).error);
    EXPECT_NE(parsed(text, 100).error.find("names vertex 4000000, but there are only 60"),
              std::string::npos);
    for (const std::string wrong : {"v 1 x 2\n", "f 1 2 -900\n", "f 0 1 2\n", "v 1 2\n"}) {
        for (const std::size_t at : {text.find("vt 0.3 "), text.find("vt 0.30 ")}) {
            std::string bad = text;
            bad.insert(at, wrong);
            const std::string expected = parsed(bad, whole).error;
            EXPECT_NE(expected.find("line "), std::string::npos) << expected;
            for (const std::size_t size : {1U, 30U, 500U})
                EXPECT_EQ(parsed(bad, size).error, expected);
        }
    }
}

TEST(ObjPieces, EndAtStatements) {
    const std::string text = "v 1 2 \\\n 3\nv 1 2 \\\r\n 3\nv 4 5 6\nv 7 8 9";
    EXPECT_EQ(obj_piece_ends(text, 1), (std::vector<std::size_t>{11, 23, 31, text.size()}));
    EXPECT_EQ(obj_piece_ends(text, 12), (std::vector<std::size_t>{23, text.size()}));
    EXPECT_EQ(obj_piece_ends(text, 1000), (std::vector<std::size_t>{text.size()}));
    EXPECT_EQ(obj_piece_ends("v 1 2 3\n", 4), (std::vector<std::size_t>{8}));
    EXPECT_EQ(obj_piece_ends("", 4), (std::vector<std::size_t>{0}));
    // Without line feeds, as on old machines, there is one piece.
    EXPECT_EQ(obj_piece_ends("v 1 2 3\rv 4 5 6\r", 4), (std::vector<std::size_t>{16}));
}

TEST_F(Obj, NamesFilesInItsFolderUnlessOthersArePermitted) {
    std::filesystem::create_directories(folder_ / "model/textures");
    write("outside.mtl", "newmtl red\nKd 1 0 0\n");
    write("model/inside.mtl",
          "newmtl red\nKd 0 1 0\nmap_Kd ../a.png\nmap_Ks textures/b.png\nnorm " +
              (folder_ / "c.png").string() + "\n");
    const auto material = [&](const std::string& library) {
        report_ = Report();
        const std::string text = "mtllib " + library + "\nusemtl red\n" + three + "f 1 2 3\n";
        return read_mesh(write("model/a.obj", text), report_).materials.at(0);
    };
    const std::string absolute = (folder_ / "outside.mtl").string();
    for (const std::string& library : {std::string("../outside.mtl"), absolute}) {
        EXPECT_EQ(material(library).diffuse, glm::vec3(0.8F)) << library;
        EXPECT_EQ(report_.count("MTL file outside the model's folder"), 1U) << library;
    }
    const MtlMaterial inside = material("textures/../inside.mtl");
    EXPECT_EQ(inside.diffuse, glm::vec3(0, 1, 0));
    EXPECT_THAT(inside.outside_maps, ElementsAre(folder_ / "a.png", folder_ / "c.png"));
    EXPECT_TRUE(inside.may_read(*inside.specular_map));
    EXPECT_FALSE(inside.may_read(*inside.diffuse_map));

    set_input_limits({0, 0, true});
    EXPECT_EQ(material("../outside.mtl").diffuse, glm::vec3(1, 0, 0));
    EXPECT_THAT(report_.findings(), IsEmpty());
    EXPECT_THAT(material("inside.mtl").outside_maps, IsEmpty());
    set_input_limits({});
}

class LargePolygon : public Obj {
  protected:
    /// Reads one polygon, and returns twice the sum of its triangles' areas.
    double area_of(const std::vector<glm::vec2>& corners) {
        std::string text;
        std::string face = "f";
        for (std::size_t i = 0; i < corners.size(); ++i) {
            text += fmt::format("v {} {} 0\n", corners[i].x, corners[i].y);
            face += fmt::format(" {}", i + 1);
        }
        const Mesh mesh = read(text + face + "\n").mesh;
        EXPECT_EQ(mesh.triangles.size(), corners.size() - 2);
        double area = 0.0;
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a(mesh.positions[t.x]);
            area += glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a,
                                           glm::dvec3(mesh.positions[t.z]) - a));
        }
        return area;
    }
};

// A search through all corners for each ear would take minutes.
TEST_F(LargePolygon, ACombIsCutIntoEars) {
    constexpr int teeth = 100'000;
    std::vector<glm::vec2> corners = {{0, -1}, {teeth, -1}};
    for (int i = teeth; i > 0; --i) {
        corners.emplace_back(i, 0);
        corners.emplace_back(static_cast<float>(i) - 0.5F, 100);
    }
    double shoelace = 0.0;  // Twice the area.
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 a(corners[i]);
        const glm::dvec2 b(corners[(i + 1) % corners.size()]);
        shoelace += a.x * b.y - a.y * b.x;
    }
    EXPECT_NEAR(area_of(corners) / shoelace, 1.0, 1e-9);
    EXPECT_THAT(report_.findings(), IsEmpty());
}

}  // namespace

}  // namespace relief
