// SPDX-License-Identifier: Apache-2.0
// Shader files: their markers, and the inputs that their declarations name.
#include "effects/shader_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "relief/shade/renderer.h"

namespace relief {
using namespace relief::shade::detail;

namespace {

using testing::ElementsAre;

std::string refusal(std::string_view text) {
    try {
        (void)parts_of("file.glsl", text);
    } catch (const shade::GpuError& error) {
        return error.what();
    }
    return "no refusal";
}

TEST(ShaderParts, BeginAtMarkers) {
    const std::vector<ShaderPart> parts = parts_of(
        "file.glsl",
        "// License.\n\n//@part one\n1\n\n//@part two implements step\n2\n//@neutral step\n3\n");
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(parts[0].address, "file.glsl#one");
    EXPECT_EQ(parts[0].step, "");
    EXPECT_EQ(parts[0].first_line, 4);
    EXPECT_THAT(parts[0].lines, ElementsAre("1"));
    EXPECT_EQ(parts[1].address, "file.glsl#two");
    EXPECT_EQ(parts[1].step, "step");
    EXPECT_FALSE(parts[1].is_neutral);
    EXPECT_EQ(parts[2].address, "file.glsl#<step>");
    EXPECT_EQ(parts[2].step, "step");
    EXPECT_TRUE(parts[2].is_neutral);
    EXPECT_THAT(parts[2].lines, ElementsAre("3"));
}

TEST(ShaderParts, OfAFileWithoutMarkersIsTheFile) {
    const std::vector<ShaderPart> parts = parts_of("file.glsl", "// Text.\nvoid main() {}\n");
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_EQ(parts[0].address, "file.glsl");
    EXPECT_EQ(parts[0].first_line, 1);
    EXPECT_EQ(parts[0].lines.size(), 2U);
    EXPECT_TRUE(parts_of("file.glsl", "// Text.\n").empty());
}

TEST(ShaderParts, ListTheirIncludes) {
    const ShaderPart part =
        parts_of("file.glsl", "//@part one\n//@include \"a.glsl#b\"\n//@include <step>\n").front();
    ASSERT_EQ(part.includes.size(), 2U);
    EXPECT_FALSE(part.includes[0].is_step);
    EXPECT_EQ(part.includes[0].name, "a.glsl#b");
    EXPECT_TRUE(part.includes[1].is_step);
    EXPECT_EQ(part.includes[1].name, "step");
}

TEST(ShaderParts, TakeTheInputsThatTheyDeclare) {
    const ShaderPart part =
        parts_of("file.glsl",
                 "in vec3 normal_object;\nout vec3 normal_world;\n"
                 "uniform vec4 points[8];  // An array.\nuniform sampler2DArrayShadow maps;\n"
                 "layout(std140) uniform Lights {\n    vec4 rows[2];\n};\n"
                 "const float uniformity = 1.0;\nvoid f(in vec3 a) {\n    in_out(a);\n}\n")
            .front();
    ASSERT_EQ(part.inputs.size(), 4U);
    EXPECT_EQ(part.inputs[0].kind, ShaderInputKind::varying);
    EXPECT_EQ(part.inputs[0].name, "normal_object");
    EXPECT_EQ(part.inputs[1].kind, ShaderInputKind::uniform);
    EXPECT_EQ(part.inputs[1].name, "points");
    EXPECT_EQ(part.inputs[2].kind, ShaderInputKind::sampler);
    EXPECT_EQ(part.inputs[2].name, "maps");
    EXPECT_EQ(part.inputs[3].kind, ShaderInputKind::block);
    EXPECT_EQ(part.inputs[3].name, "Lights");
}

TEST(ShaderParts, RefuseMalformedFiles) {
    EXPECT_EQ(refusal("//@part a b\n"), "shader file.glsl:1: '//@part a b' names no part");
    EXPECT_EQ(refusal("\n//@part a implements b c\n"),
              "shader file.glsl:2: '//@part a implements b c' names no step");
    EXPECT_EQ(refusal("//@neutral \n"), "shader file.glsl:1: '//@neutral ' names no step");
    EXPECT_EQ(refusal("//@part a\n//@step b\n"), "shader file.glsl:2: '//@step b' is not a marker");
    EXPECT_EQ(refusal("//@part a\n//@include b\n"),
              "shader file.glsl:2: '//@include b' is not a marker");
    EXPECT_EQ(refusal("//@part a\n1\n//@part a\n2\n"),
              "shader file.glsl:3: there are two parts '//@part a'");
    EXPECT_EQ(refusal("float x;\n//@part a\n"),
              "shader file.glsl:1: code before the first //@part");
}

TEST(EmbeddedParts, AreFoundByAddressAndStep) {
    for (const ShaderPart& part : embedded_parts()) {
        EXPECT_EQ(find_embedded_part(part.address), &part);
        if (part.is_neutral) {
            EXPECT_EQ(find_neutral_code(part.step), &part) << "a step has one neutral code";
        }
        for (const ShaderInclude& include : part.includes) {
            if (!include.is_step) {
                EXPECT_NE(find_embedded_part(include.name), nullptr) << part.address;
            }
        }
    }
    EXPECT_EQ(find_embedded_part("nowhere.glsl#part"), nullptr);
    EXPECT_EQ(find_neutral_code("no_step"), nullptr);
}

TEST(EmbeddedParts, NeutralCodeHasNoInputs) {
    std::set<std::string_view> steps;
    for (const ShaderPart& part : embedded_parts()) {
        if (!part.is_neutral) steps.insert(part.step);
    }
    for (const ShaderPart& part : embedded_parts()) {
        if (!part.is_neutral) continue;
        EXPECT_TRUE(part.inputs.empty()) << part.address;
        EXPECT_TRUE(part.includes.empty()) << part.address;
        EXPECT_TRUE(steps.contains(part.step)) << part.address << " belongs to no part";
    }
}

}  // namespace
}  // namespace relief
