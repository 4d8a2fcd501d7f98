// SPDX-License-Identifier: Apache-2.0
// Includes and parts: order, once only, cycles, missing ones, overrides, and the origin of a line.
#include "effects/shader_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "relief/shade/error.h"
#include "support/gl_environment.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using ::testing::HasSubstr;

/// A folder of shader files that goes before the embedded ones.
class ShaderFolder : public ::testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }

  private:
    test::TemporaryDirectory folder_;
    test::ScopedVariable variable_{"RELIEF_SHADER_DIR", folder_.path().c_str()};
};

std::string refusal(std::string_view file, const ShaderSteps& steps) {
    try {
        (void)assemble(file, steps, {});
    } catch (const GpuError& error) {
        return error.what();
    }
    return "no refusal";
}

TEST_F(ShaderFolder, PutsFilesTogetherOnceEach) {
    write("main.glsl", "#include \"a.glsl\"\n#include <step>\nmain\n");
    write("a.glsl", "a\n");
    write("b.glsl", "#include \"a.glsl\"\nb\n");
    const ShaderSource source =
        assemble("main.glsl", {{"step", {.part = "b.glsl"}}}, {{"count", 3}});
    EXPECT_EQ(source.text, "#version 330 core\nconst int count = 3;\na\nb\nmain\n");
    EXPECT_EQ(source.parts, (std::vector<std::string>{"main.glsl", "a.glsl", "b.glsl"}));
}

TEST_F(ShaderFolder, KnowsWhereEachLineCameFrom) {
    write("main.glsl", "first\n#include \"a.glsl\"\nlast\n");
    write("a.glsl", "one\ntwo\n");
    const ShaderSource source = assemble("main.glsl", {}, {});
    // 1: version, 2: main.glsl:1, 3: a.glsl:1, 4: a.glsl:2, 5: main.glsl:3.
    EXPECT_EQ(with_file_names("0:4(7): error: what\n0:5(1): error: that", source),
              "a.glsl:2(7): error: what\nmain.glsl:3(1): error: that");
    EXPECT_EQ(with_file_names("0(3) : error C1008", source), "a.glsl:1 : error C1008");
}

TEST_F(ShaderFolder, LeavesOtherNumbersInMessagesAlone) {
    write("main.glsl", "x\n");
    const ShaderSource source = assemble("main.glsl", {}, {});
    for (const char* message : {"0:1(1): the version line", "0:99(1): beyond", "no number", "",
                                "10:2 is a time", "0:99999999999999999999(1)"}) {
        EXPECT_EQ(with_file_names(message, source), message);
    }
}

TEST_F(ShaderFolder, RefusesCycles) {
    write("a.glsl", "#include \"b.glsl\"\n");
    write("b.glsl", "\n#include \"a.glsl\"\n");
    EXPECT_EQ(refusal("a.glsl", {}),
              "shader b.glsl:2: a.glsl includes itself: a.glsl -> b.glsl -> a.glsl");
}

TEST_F(ShaderFolder, NamesWhatIsMissingAndWhere) {
    write("main.glsl", "\n#include \"nowhere.glsl\"\n");
    EXPECT_EQ(refusal("main.glsl", {}),
              "shader main.glsl:2: there is no shader file 'nowhere.glsl'");
    write("main.glsl", "#include <step>\n");
    EXPECT_EQ(refusal("main.glsl", {}), "shader main.glsl:1: no part is chosen for <step>");
    write("main.glsl", "#include stray\n");
    EXPECT_THAT(refusal("main.glsl", {}), HasSubstr("shader main.glsl:1"));
    EXPECT_EQ(refusal("nowhere.glsl", {}), "there is no shader file 'nowhere.glsl'");
}

TEST_F(ShaderFolder, TakesPartsOutOfFiles) {
    write("main.glsl",
          "// Comments.\n\n#part one\n1\n\n#part two\n#include \"main.glsl#three\"\n2\n#part "
          "three\n3\n");
    const ShaderSource source = assemble("main.glsl#two", {}, {});
    EXPECT_EQ(source.text, "#version 330 core\n3\n2\n");
    EXPECT_EQ(source.parts, (std::vector<std::string>{"main.glsl#two", "main.glsl#three"}));
    EXPECT_EQ(with_file_names("0:2(1): a\n0:3(1): b", source),
              "main.glsl:10(1): a\nmain.glsl:8(1): b");
    EXPECT_EQ(assemble("main.glsl#one", {}, {}).text, "#version 330 core\n1\n");
    EXPECT_EQ(refusal("main.glsl#four", {}), "there is no part 'four' in shader file 'main.glsl'");
}

TEST_F(ShaderFolder, PutsNeutralCodeInOnce) {
    write("main.glsl", "#include <step>\nfirst\n#include <step>\nlast\n");
    const ShaderSource source = assemble("main.glsl", {{"step", {.neutral = "void f() {}"}}}, {});
    EXPECT_EQ(source.text, "#version 330 core\nvoid f() {}\nfirst\nlast\n");
    EXPECT_EQ(with_file_names("0:2(1): in no file; 0:4(1): here", source),
              "0:2(1): in no file; main.glsl:4(1): here");
}

TEST_F(ShaderFolder, RefusesCodeThatIsInNoPart) {
    write("main.glsl", "// A comment.\nuniform float x;\n#part one\n1\n");
    EXPECT_EQ(refusal("main.glsl#one", {}), "shader main.glsl:2: code before the first #part");
}

TEST_F(ShaderFolder, OverridesEmbeddedPartsOneByOne) {
    const ShaderSteps no_diffuse = {{"diffuse", {.neutral = "d"}}, {"specular", {.neutral = "s"}}};
    const std::string embedded = assemble("phong.glsl#receive", no_diffuse, {}).text;
    EXPECT_THAT(embedded, HasSubstr("void receive("));
    EXPECT_THAT(assemble("phong.glsl#lambert", {}, {}).text, HasSubstr("diffuse_color"));
    write("phong.glsl", "#part lambert\nmine\n");
    EXPECT_EQ(assemble("phong.glsl#lambert", {}, {}).text, "#version 330 core\nmine\n");
    EXPECT_EQ(assemble("phong.glsl#receive", no_diffuse, {}).text, embedded);
}

TEST(EmbeddedShaders, AreTheFilesOfTheProject) {
    std::size_t files = 0;
    const std::filesystem::path folder = test::source_directory() / "shaders";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".glsl") ++files;
    }
    EXPECT_EQ(embedded_shaders().size(), files);
    for (const EmbeddedShader& shader : embedded_shaders()) {
        std::ifstream file(folder / shader.name);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        EXPECT_EQ(shader.text, text) << shader.name;
        EXPECT_THAT(text, ::testing::StartsWith("// SPDX-License-Identifier: Apache-2.0\n//"));
    }
}

}  // namespace
}  // namespace relief
