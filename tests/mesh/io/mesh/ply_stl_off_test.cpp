// SPDX-License-Identifier: Apache-2.0
// PLY, STL and OFF files: all variants, broken files, and the triangulation of polygons.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>

#include "io/mesh/polygon_mesh.h"
#include "mesh/io/mesh/mesh_files.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::detail;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Ply : public test::MeshTextTest {
  protected:
    Ply() : MeshTextTest("a.ply") {}
};

const std::string ascii_vertices =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n";
const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string binary_head =
    "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float "
    "y\nproperty float z\n";

TEST_F(Ply, AsciiIsReadLineByLine) {
    const Mesh mesh =
        read(ascii_vertices + faces + "0 0 0 9 9\n1 0 nan\n0 1 -inf\n3 0 1 2 7\n").mesh;
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2)));
    EXPECT_TRUE(std::isnan(mesh.positions[1].z));
    EXPECT_EQ(report_.count("line with more values than the header names"), 2U);
}

TEST_F(Ply, StripsBecomeTriangles) {
    const Mesh mesh = read(
                          "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty "
                          "float y\nproperty float z\nelement tristrips 1\nproperty list int int "
                          "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
                          "8 0 1 2 3 -1 0 1 3\n")
                          .mesh;
    EXPECT_THAT(mesh.triangles,
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(2, 1, 3), glm::uvec3(0, 1, 3)));
}

TEST_F(Ply, PointsAreNamed) {
    EXPECT_THAT(error_of(ascii_vertices + "end_header\n0 0 0\n1 0 0\n0 1 0\n"),
                HasSubstr("has no triangle, only 3 points"));
}

TEST_F(Ply, DataBehindTheLastElementIsReported) {
    const std::string complete = ascii_vertices + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_EQ(read(complete + "\n \n").mesh.triangles.size(), 1U);
    EXPECT_EQ(report_.count("data behind the last element"), 0U);
    EXPECT_EQ(read(complete + "3 2 1 0\n").mesh.triangles.size(), 1U);
    EXPECT_EQ(report_.count("data behind the last element"), 1U);
    EXPECT_THAT(report_.findings().back().first, ElementsAre(complete.size()));
}

TEST_F(Ply, VAndTArePointingUpInTheFileAndDownInTheMesh) {
    const Mesh mesh = read(ascii_vertices + "property float s\nproperty float t\n" + faces +
                           "0 0 0 0.5 0.25\n1 0 0 1 1\n0 1 0 0 0\n3 0 1 2\n")
                          .mesh;
    EXPECT_THAT(mesh.texcoords,
                ElementsAre(glm::vec2(0.5F, 0.75F), glm::vec2(1, 0), glm::vec2(0, 1)));
}

TEST_F(Ply, TextureCoordinatesByFaceSplitVertices) {
    const Mesh mesh =
        read(
            ascii_vertices +
            "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float "
            "texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n3 0 1 2 6 0 0 1 0 1 "
            "1\n")
            .mesh;
    EXPECT_THAT(mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 1, 3)));
    EXPECT_EQ(mesh.positions[3], glm::vec3(0, 1, 0));
    EXPECT_EQ(mesh.texcoords[3], glm::vec2(1, 0));
}

TEST_F(Ply, IsolatedAndEqualVerticesAreKept) {
    const Mesh mesh = read(
                          "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty "
                          "float y\nproperty float z\n" +
                          faces + "0 0 0\n0 0 0\n1 0 0\n0 1 0\n5 5 5\n3 0 2 3\n")
                          .mesh;
    EXPECT_EQ(mesh.positions.size(), 5U);
}

TEST_F(Ply, HostileCountsAreRefusedBeforeMemoryIsTaken) {
    EXPECT_THAT(error_of("ply\nformat binary_little_endian 1.0\nelement vertex "
                         "4000000000000\nproperty float x\nproperty float y\nproperty float z\n" +
                         faces),
                HasSubstr("claims 4000000000000 of element 'vertex'"));
    const std::string list = binary_head +
                             "element face 1\nproperty list int int vertex_indices\nend_header\n" +
                             std::string(12, '\0');
    EXPECT_THAT(error_of(list + std::string("\x00\x94\x35\x77", 4)), HasSubstr("2000000000"));
    EXPECT_THAT(error_of(list + std::string("\xFB\xFF\xFF\xFF", 4)), HasSubstr("length -5"));
    EXPECT_THAT(error_of(list + std::string("\x03\0\0\0\0\0\0\0", 8)), HasSubstr("length 3"));
    EXPECT_THAT(error_of(ascii_vertices + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
                HasSubstr("face 0 names vertex 3, but there are only 3"));
    EXPECT_THAT(error_of(ascii_vertices + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
                HasSubstr("face 0 names vertex -1"));
    EXPECT_THAT(error_of(ascii_vertices + faces + "0 0 0\n1 0 0\n0 1\n"),
                HasSubstr("the file ends"));
}

TEST_F(Ply, MalformedHeadersAreRefusedByLine) {
    EXPECT_THAT(error_of("plx\n"), HasSubstr("does not begin with 'ply'"));
    EXPECT_THAT(error_of("ply\nformat ascii 1.0\nelement vertex many\n"),
                HasSubstr("line 3: an element has the count 'many'"));
    EXPECT_THAT(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n"),
                HasSubstr("line 4: 'half' is not a PLY type"));
    EXPECT_THAT(error_of("ply\nelement vertex 1\n"), HasSubstr("no end_header"));
    EXPECT_THAT(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int a\n"),
                HasSubstr("counted in a floating-point type"));
}

/// A binary file whose faces are triangles, except that one may be a quad.
std::string strip_of_triangles(std::uint32_t count, std::uint32_t quad, bool is_big_endian,
                               const std::string& header_lines = "") {
    std::string bytes = fmt::format(
        "ply\nformat binary_{}_endian 1.0\n{}element vertex {}\nproperty float x\nproperty float "
        "y\nproperty float z\nelement face {}\nproperty list uchar uint vertex_indices\n"
        "end_header\n",
        is_big_endian ? "big" : "little", header_lines, count + 3, count);
    const auto add = [&](const auto value) {
        auto raw = std::bit_cast<std::array<char, sizeof(value)>>(value);
        if (is_big_endian) std::reverse(raw.begin(), raw.end());
        bytes.append(raw.begin(), raw.end());
    };
    for (std::uint32_t i = 0; i < count + 3; ++i) {
        for (const std::uint32_t value : {i, i % 2, i % 3})
            add(static_cast<float>(value));
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint8_t corners = i == quad ? 4 : 3;
        add(corners);
        for (std::uint32_t k = 0; k < corners; ++k)
            add(i + k);
    }
    return bytes;
}

TEST_F(Ply, LargeFilesAreReadInPiecesOfAnySize) {
    constexpr std::uint32_t count = 100'003;  // 2.5 MB; no value ends with a piece.
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    for (const bool is_big_endian : {false, true}) {
        for (const std::uint32_t quad : {none, 0U, 70'000U, count - 1}) {
            SCOPED_TRACE(fmt::format("big endian {}, quad {}", is_big_endian, quad));
            const Mesh mesh = read(strip_of_triangles(count, quad, is_big_endian)).mesh;
            ASSERT_EQ(mesh.positions.size(), count + 3);
            ASSERT_EQ(mesh.triangles.size(), count + (quad == none ? 0 : 1));
            for (std::uint32_t i = 0; i < count + 3; ++i)
                ASSERT_EQ(mesh.positions[i], glm::vec3(i, i % 2, i % 3));
            std::size_t next = 0;
            for (std::uint32_t i = 0; i < count; ++i) {
                const glm::uvec3 last = mesh.triangles[next + (i == quad ? 1 : 0)];
                if (i == quad) {
                    ASSERT_EQ(last[2], i + 3);
                } else {
                    ASSERT_EQ(last, glm::uvec3(i, i + 1, i + 2));
                }
                next += i == quad ? 2 : 1;
            }
        }
    }
    EXPECT_TRUE(report_.empty());
}

TEST_F(Ply, LongHeadersAreReadToTheirEnd) {
    std::string comments = "comment end_header is not here\n";
    for (int i = 0; i < 3000; ++i)
        comments += "comment a line that makes the header longer than the first piece\n";
    EXPECT_EQ(read(strip_of_triangles(5, 9, false, comments)).mesh.triangles.size(), 5U);
}

TEST_F(Ply, TrianglesOfMissingVerticesAreNamedWithTheFace) {
    std::string bytes = strip_of_triangles(3, 9, false);
    const auto set_last_index = [&](const std::uint32_t index) {
        std::memcpy(bytes.data() + bytes.size() - 4, &index, 4);
    };
    set_last_index(6);
    EXPECT_THAT(error_of(bytes), HasSubstr("face 2 names vertex 6, but there are only 6"));
    set_last_index(0xFFFFFFFF);
    EXPECT_THAT(error_of(bytes), HasSubstr("face 2 names vertex 4294967295"));
    const std::size_t type = bytes.find("uchar uint");
    bytes.replace(type, 10, "uchar int ");
    EXPECT_THAT(error_of(bytes), HasSubstr("face 2 names vertex -1"));
    bytes.resize(bytes.size() - 2);
    EXPECT_THAT(error_of(bytes), HasSubstr("has the length 3, which the file cannot hold"));
}

TEST_F(Ply, RoundTrips) {
    MeshFile contents{test::sphere(16, 8), {}};
    for (std::size_t i = 0; i < contents.mesh.positions.size(); ++i) {
        contents.mesh.colors.emplace_back(static_cast<float>(i % 256) / 255.0F, 0.0F, 1.0F, 0.2F);
    }
    for (const bool has_fractions : {false, true}) {
        if (has_fractions) contents.mesh.colors[3].g = 0.123F;
        write_mesh(folder_ / "b.ply", contents);
        const Mesh mesh = read_mesh(folder_ / "b.ply", report_).mesh;
        EXPECT_EQ(mesh.positions, contents.mesh.positions);
        EXPECT_EQ(mesh.normals, contents.mesh.normals);
        EXPECT_EQ(mesh.colors, contents.mesh.colors);
        EXPECT_EQ(mesh.triangles, contents.mesh.triangles);
        ASSERT_EQ(mesh.texcoords.size(), contents.mesh.texcoords.size());
        for (std::size_t i = 0; i < mesh.texcoords.size(); ++i) {
            EXPECT_EQ(mesh.texcoords[i].x, contents.mesh.texcoords[i].x);
            // 1 - v is rounded to float in the file: half a unit in the last place of 1.
            EXPECT_NEAR(mesh.texcoords[i].y, contents.mesh.texcoords[i].y, 6e-8);
        }
    }
}

TEST_F(Ply, EveryScalarTypeAndByteOrderGivesTheSameShape) {
    RELIEF_NEEDS_SHARED(magnum, "data/models/ply/magnum");
    // All of these files hold the same five vertices, a quad and a triangle.
    const Mesh reference = read_mesh(magnum / "positions-float-indices-uint.ply", report_).mesh;
    int read_count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(magnum)) {
        if (entry.path().filename() == "ascii.ply") continue;
        const Mesh mesh = read_mesh(entry.path(), report_).mesh;
        EXPECT_EQ(mesh.positions, reference.positions) << entry.path();
        EXPECT_EQ(mesh.triangles, reference.triangles) << entry.path();
        ++read_count;
    }
    EXPECT_EQ(read_count, 12);
    const Mesh colored =
        read_mesh(magnum /
                      "positions-colors-normals-texcoords-float-objectid-uint-indices-int."
                      "ply",
                  report_)
            .mesh;
    EXPECT_EQ(colored.normals.size(), 5U);
    EXPECT_EQ(colored.texcoords.size(), 5U);
    EXPECT_EQ(colored.colors.size(), 5U);
}

TEST_F(Ply, TheSameModelAsPlyAndAsObjHasTheSameTextureCoordinates) {
    RELIEF_NEEDS_SHARED(ply, "data/models/ply/fuze_ascii.ply");
    RELIEF_NEEDS_SHARED(obj, "data/models/obj/fuze/fuze.obj");
    const Mesh from_ply = read_mesh(ply, report_).mesh;
    const Mesh from_obj = read_mesh(obj, report_).mesh;
    ASSERT_EQ(from_ply.triangles.size(), from_obj.triangles.size());
    ASSERT_EQ(from_ply.positions.size(), from_obj.positions.size());
    // The same tool wrote both with six decimals. The flip of v must be the same in both.
    for (std::size_t i = 0; i < from_ply.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec2 difference = from_ply.texcoords[from_ply.triangles[i][k]] -
                                         from_obj.texcoords[from_obj.triangles[i][k]];
            ASSERT_LT(glm::length(difference), 2e-6F) << "triangle " << i;
        }
    }
}

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
                HasSubstr("line 4: expected a number, but found '1,5'"));
    EXPECT_THAT(error_of("solid\nfacet outer loop vertex 0 0 0 vertex 1 1 1 endloop"),
                HasSubstr("line 2: a facet has 2 corners instead of 3"));
    EXPECT_THAT(error_of("solid\nfacet outer loop vertex 0 0 0"), HasSubstr("ends inside a facet"));
    const std::string facet_text =
        "solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop";
    EXPECT_THAT(error_of(facet_text), HasSubstr("line 2: the file ends inside a facet"));
    EXPECT_THAT(error_of(facet_text + " endfacet facet normal 0"),
                HasSubstr("ends inside a facet"));
    EXPECT_EQ(read(facet_text + " endfacet\nendsolid").mesh.triangles.size(), 1U);
    EXPECT_EQ(report_.count("solid without an end"), 0U);
    EXPECT_EQ(read(facet_text + " endfacet").mesh.triangles.size(), 1U);
    EXPECT_EQ(report_.count("solid without an end"), 1U);
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

class Off : public test::MeshTextTest {
  protected:
    Off() : MeshTextTest("a.off") {}
};

TEST_F(Off, TextBehindTheLastFaceIsReported) {
    EXPECT_EQ(read("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n# end\n").mesh.triangles.size(), 1U);
    EXPECT_EQ(report_.count("text behind the last face"), 0U);
    EXPECT_EQ(read("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n").mesh.triangles.size(), 1U);
    EXPECT_EQ(report_.count("text behind the last face"), 1U);
}

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

TEST_F(Off, OrderIsNormalsColorsTextureCoordinates) {
    const Mesh mesh =
        read(
            "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 51 255 0.25 0.25\n1 0 0 0 0 1 1.0 0.5 0 0 1\n"
            "0 1 0 0 0 1 0 0 0 0 0 0\n3 0 1 2\n")
            .mesh;
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(mesh.texcoords[0], glm::vec2(0.25F, 0.75F));
    // In the first line, only the texture coordinates have a decimal point.
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
    EXPECT_THAT(error_of("4OFF\n1 1 0\n"),
                HasSubstr("'4OFF' is a kind of OFF that relief does not read"));
    EXPECT_THAT(error_of("OFF BINARY\n"), HasSubstr("vertex count"));
    EXPECT_THAT(error_of("solid\n"), HasSubstr("does not begin with 'OFF'"));
}

using Points = std::vector<glm::vec3>;

std::vector<glm::uvec3> cut(const Points& positions, const std::vector<glm::vec2>& texcoords = {}) {
    std::vector<glm::uvec3> triangles;
    EXPECT_EQ(triangulate_polygon(positions, texcoords, triangles), PolygonCut::ears);
    return triangles;
}

/// Returns twice the signed area in the xy plane.
double area(const Points& p, const glm::uvec3& t) {
    const glm::dvec3 cross = glm::cross(glm::dvec3(p[t.y]) - glm::dvec3(p[t.x]),
                                        glm::dvec3(p[t.z]) - glm::dvec3(p[t.x]));
    return cross.z;
}

double polygon_area(const Points& p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const glm::dvec3 a(p[i]);
        const glm::dvec3 b(p[(i + 1) % p.size()]);
        sum += a.x * b.y - a.y * b.x;
    }
    return sum;
}

const Points unit_square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(PolygonTriangulation, ASquareIsCutFromFirstToThirdCorner) {
    EXPECT_THAT(cut(unit_square), ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
}

TEST(PolygonTriangulation, AQuadIsCutAlongItsShorterDiagonal) {
    EXPECT_THAT(cut({{0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {0, 1, 0}}),
                ElementsAre(glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3)));
}

TEST(PolygonTriangulation, TheTextureDecidesBeforeTheSpace) {
    // The diagonal from the first to the third vertex is longer in space and shorter in the
    // texture.
    const std::vector<glm::vec2> texcoords = {{0, 0}, {2, 0}, {1, 1}, {-1, 1}};
    EXPECT_THAT(cut({{0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {0, 1, 0}}, texcoords),
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
    // The diagonals are equal in the texture, so space decides.
    EXPECT_THAT(cut({{0, 0, 0}, {1, 0, 0}, {3, 1, 0}, {0, 1, 0}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}),
                ElementsAre(glm::uvec3(0, 1, 3), glm::uvec3(1, 2, 3)));
}

TEST(PolygonTriangulation, ConcaveQuadIsCutAtItsReflexCorner) {
    // Each corner in turn is reflex, and the texture prefers the other diagonal.
    const Points arrow = {{0, 0, 0}, {4, -1, 0}, {1, 0, 0}, {4, 1, 0}};
    for (std::size_t turn = 0; turn < 4; ++turn) {
        Points turned;
        for (std::size_t i = 0; i < 4; ++i)
            turned.push_back(arrow[(i + turn) % 4]);
        for (const glm::vec2& stretch : {glm::vec2(9, 1), glm::vec2(1, 9)}) {
            std::vector<glm::vec2> texcoords;
            for (const glm::vec2& corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
                texcoords.push_back({corner.x * stretch.x + corner.y, corner.y * stretch.y});
            }
            for (const glm::uvec3& triangle : cut(turned, texcoords)) {
                EXPECT_GT(area(turned, triangle), 0.0) << "turned by " << turn;
            }
        }
    }
}

TEST(PolygonTriangulation, AConvexPolygonBecomesAFanAroundItsFirstCorner) {
    EXPECT_THAT(cut({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}}),
                ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(0, 3, 4)));
}

/// A star with as many concave as convex corners, in a tilted plane of any scale.
Points star(std::size_t corners, float scale) {
    Points points;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle =
            2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        const double radius = i % 2 == 0 ? 1.0 : 0.4;
        points.push_back(scale * glm::vec3(radius * std::cos(angle), radius * std::sin(angle), 0));
    }
    return points;
}

TEST(PolygonTriangulation, AConcavePolygonIsCoveredExactlyOnceAtAnyScale) {
    for (const float scale : {1e-30F, 1.0F, 1e18F}) {
        const Points points = star(10, scale);
        double sum = 0.0;
        const std::vector<glm::uvec3> triangles = cut(points);
        EXPECT_EQ(triangles.size(), 8U);
        for (const glm::uvec3& triangle : triangles) {
            EXPECT_GT(area(points, triangle), 0.0);
            sum += area(points, triangle);
        }
        // Sums of ten products of floats in double.
        EXPECT_NEAR(sum / polygon_area(points), 1.0, 1e-12) << scale;
    }
}

TEST(PolygonTriangulation, CornersOnAStraightEdgeAreKept) {
    const Points points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    double sum = 0.0;
    for (const glm::uvec3& triangle : cut(points)) {
        EXPECT_GT(area(points, triangle), 0.0);
        sum += area(points, triangle);
    }
    EXPECT_EQ(sum, 8.0);
}

TEST(PolygonTriangulation, AHoleReachedThroughABridgeIsLeftOpen) {
    // A square with a square hole, connected by the double edge between corners 3 and 4 of the
    // list.
    const Points points = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                           {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    double sum = 0.0;
    for (const glm::uvec3& triangle : cut(points)) {
        EXPECT_GE(area(points, triangle), 0.0);
        sum += area(points, triangle);
    }
    EXPECT_EQ(sum, 2.0 * (16.0 - 4.0));
}

TEST(PolygonTriangulation, DegeneratePolygonBecomesAFanWithAFinding) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Points> polygons = {
        Points(6, glm::vec3(1.0F)),
        {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}},
        {{0, 0, 0}, {1, 0, 0}, {2, nan, 0}, {1, 1, 0}, {0, 1, 0}},
        {{0, 0, 0},
         {1, 0, 0},
         {1, std::numeric_limits<float>::infinity(), 0},
         {1, 1, 0},
         {0, 1, 0}},
    };
    for (const Points& points : polygons) {
        std::vector<glm::uvec3> triangles;
        EXPECT_EQ(triangulate_polygon(points, {}, triangles), PolygonCut::fan);
        ASSERT_EQ(triangles.size(), points.size() - 2);
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            EXPECT_EQ(triangles[i], glm::uvec3(0, i + 1, i + 2));
        }
    }
}

TEST(PolygonTriangulation, QuadsWithNaNAreStillTwoTriangles) {
    Points points = unit_square;
    points[2].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(cut(points), ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)));
}

TEST(PolygonTriangulation, TenThousandCornersTakeLessThanASecond) {
    const auto begin = std::chrono::steady_clock::now();
    const Points points = star(10'000, 1.0F);
    double sum = 0.0;
    for (const glm::uvec3& triangle : cut(points))
        sum += area(points, triangle);
    EXPECT_NEAR(sum / polygon_area(points), 1.0, 1e-9);
    // The triangulation takes about ten milliseconds. An algorithm of third order would take
    // minutes.
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

}  // namespace
}  // namespace relief
