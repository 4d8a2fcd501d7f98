// SPDX-License-Identifier: Apache-2.0
// An OBJ file read in pieces of any size says what it says in one.
#include "io/mesh/obj_pieces.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::size_t whole = 1 << 20;

/// Everything that what comes before has a say in, with some faces of our choice among them.
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

TEST(ObjPieces, HaveNoNameWhereThereAreSeveralObjects) {
    const std::string there = every_statement("f 4 1 2\n") + "o second\nf 1 2 3\n";
    EXPECT_EQ(parsed(there, whole).error, "");
    EXPECT_EQ(parsed(there, whole).statements.name, "");
    EXPECT_EQ(parsed(there, 100).statements.name, "");
}

TEST(ObjPieces, SayTheSameOfWhatIsWrong) {
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

TEST(ObjPieces, EndWhereAStatementDoes) {
    const std::string text = "v 1 2 \\\n 3\nv 1 2 \\\r\n 3\nv 4 5 6\nv 7 8 9";
    EXPECT_EQ(obj_piece_ends(text, 1), (std::vector<std::size_t>{11, 23, 31, text.size()}));
    EXPECT_EQ(obj_piece_ends(text, 12), (std::vector<std::size_t>{23, text.size()}));
    EXPECT_EQ(obj_piece_ends(text, 1000), (std::vector<std::size_t>{text.size()}));
    EXPECT_EQ(obj_piece_ends("v 1 2 3\n", 4), (std::vector<std::size_t>{8}));
    EXPECT_EQ(obj_piece_ends("", 4), (std::vector<std::size_t>{0}));
    // No line feed, as on old machines: one piece.
    EXPECT_EQ(obj_piece_ends("v 1 2 3\rv 4 5 6\r", 4), (std::vector<std::size_t>{16}));
}

}  // namespace
}  // namespace relief
