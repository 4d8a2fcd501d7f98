// SPDX-License-Identifier: Apache-2.0
// Texts that replace parts of shaders: their order of precedence, and parts in the text of a file.
#include "relief/shade/shader_texts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "effects/shader_source.h"
#include "relief/shade/renderer.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A folder of shader files, as $RELIEF_SHADER_DIR.
class ShaderTextsFolder : public ::testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }

  private:
    test::TemporaryDirectory folder_;
    test::ScopedVariable variable_{"RELIEF_SHADER_DIR", folder_.path().c_str()};
};

TEST_F(ShaderTextsFolder, PrecedeTheFolderAndTheBuiltInFiles) {
    const auto lambert = [](const ShaderTexts& texts) {
        return assemble("phong.glsl#lambert", {}, {}, GlslVersion::core_330, texts).text;
    };
    const std::string built_in = lambert({});
    EXPECT_THAT(built_in, HasSubstr("diffuse_color"));
    write("phong.glsl", "//@part lambert\nof the folder\n");
    EXPECT_EQ(lambert({}), "#version 330 core\nof the folder\n");
    EXPECT_EQ(lambert({{}, false}), built_in);
    const ShaderTexts edited{{{"phong.glsl", "//@part lambert\nedited\n"}}, true};
    EXPECT_EQ(lambert(edited), "#version 330 core\nedited\n");
    // A text without the part leaves it to the folder.
    EXPECT_EQ(lambert({{{"phong.glsl", "//@part other\nx\n"}}, true}),
              "#version 330 core\nof the folder\n");
}

TEST_F(ShaderTextsFolder, NameTheLineOfAPart) {
    const ShaderPartText built_in = shader_part_text("phong.glsl#phong");
    EXPECT_EQ(built_in.file, "phong.glsl");
    EXPECT_THAT(built_in.text, StartsWith("//@part phong implements specular\n"));
    EXPECT_THAT(built_in.text, Not(HasSubstr("//@part blinn_phong")));
    write("phong.glsl", "// Mine.\n\n//@part phong\nfirst\nlast\n\n//@part lambert\n");
    const ShaderPartText part = shader_part_text("phong.glsl#phong");
    EXPECT_EQ(part.first_line, 3);
    EXPECT_EQ(part.text, "//@part phong\nfirst\nlast\n");
    EXPECT_FALSE(part.is_built_in);
    EXPECT_TRUE(built_in.is_built_in);
    const ShaderPartText whole = shader_part_text("surface.frag.glsl");
    EXPECT_EQ(whole.first_line, 1);
    EXPECT_THAT(whole.text, StartsWith("// SPDX"));
    EXPECT_EQ(shader_part_text("phong.glsl#phong", {{}, false}).text, built_in.text);
    EXPECT_THROW((void)shader_part_text("phong.glsl#nothing"), GpuError);
}

// All parts of the files are what with_shader_part() puts there, so that saving and reading agree.
TEST(ShaderPartTexts, MakeUpTheFileAgain) {
    std::string file;
    for (const ShaderPart& part : embedded_parts()) {
        if (part.file != "phong.glsl" || part.is_neutral) continue;
        const std::string text = shader_part_text(part.address).text;
        file = with_shader_part(file, part.address, text);
        EXPECT_EQ(shader_part_text(part.address, {{{"phong.glsl", file}}, false}).text, text);
    }
    const std::string three = "// Head.\n//@part a\n1\n\n//@part b\n2\n\n//@part c\n3\n";
    EXPECT_EQ(with_shader_part(three, "x.glsl#b", "//@part b\nnew\n"),
              "// Head.\n//@part a\n1\n\n//@part b\nnew\n\n//@part c\n3\n");
    EXPECT_EQ(with_shader_part(three, "x.glsl#c", "//@part c\nnew"),
              "// Head.\n//@part a\n1\n\n//@part b\n2\n\n//@part c\nnew\n");
    EXPECT_EQ(with_shader_part("", "x.glsl#b", "//@part b\n2\n"), "//@part b\n2\n");
    EXPECT_EQ(with_shader_part("old\n", "x.glsl", "new\n"), "new\n");
}

}  // namespace
}  // namespace relief
