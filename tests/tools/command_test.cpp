// SPDX-License-Identifier: Apache-2.0
// Common behavior of all tools: exit codes, error lines, --version, --help, stages.
// tests/docs/documents_test.cpp runs the examples of the help pages.
#include "common/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "tools/help_pages.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using test::ProgramResult;
using test::Workplace;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::StartsWith;

struct WrongUsage {
    const char* line;
    const char* error;
};

TEST(AllTools, ExplainThatNoThreadCanBeStarted) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "Sanitizers need threads of their own.";
#endif
    const Workplace workplace;
    // The limit does not apply to root.
    std::filesystem::permissions(workplace / "", std::filesystem::perms::all);
    std::filesystem::permissions(workplace / "out", std::filesystem::perms::all);
    const std::string user = ::geteuid() == 0 ? "setpriv --reuid=65533 --clear-groups " : "";
    const ProgramResult result = workplace.run(
        user + "prlimit --nproc=1 relief-bake mesh data/urn-high.ply data/urn-low.obj out/map.png");
    if (result.error.find("Permission denied") != std::string::npos)
        GTEST_SKIP() << "Another user cannot run the tools here.";
    EXPECT_EQ(result.error,
              "relief-bake: error: no thread can be started: pthread_create has failed: Resource "
              "temporarily unavailable (raise the limit of processes, ulimit -u)\n");
}

TEST(AllTools, ExplainWrongUsageInOneLineAndExitWith2) {
    const Workplace workplace;
    const std::vector<WrongUsage> rows = {
        {"relief-mesh",
         "relief-mesh: error: a command is missing: process or decimate or lods or subdivide or "
         "displace or repair or remesh or unwrap or material or info or check or compare or "
         "conformance (see "
         "relief-mesh --help)"},
        {"relief-mesh proces a b",
         "relief-mesh: error: proces: unknown command (did you mean process?)"},
        {"relief-mesh fly", "relief-mesh: error: fly: unknown command (see relief-mesh --help)"},
        {"relief-mesh process",
         "relief-mesh: error: IN is missing (see relief-mesh process --help)"},
        {"relief-mesh process a.obj",
         "relief-mesh: error: OUT is missing (see relief-mesh process --help)"},
        {"relief-mesh process '' b.obj",
         "relief-mesh: error: '': not a file name (see relief-mesh process --help)"},
        {"relief-mesh process a.obj b.obj c.obj",
         "relief-mesh: error: 3 files: inputs and output are ambiguous "
         "(for several inputs, give a folder: -o out/)"},
        {"relief-mesh process a.obj b.obj --normal flat",
         "relief-mesh: error: --normal: unknown option (did you mean --normals?)"},
        {"relief-bake bump a.png b.png --flat half",
         "relief-bake: error: --flat: is now called --zero-code (give --zero-code 127.5 for half, "
         "128 for middle)"},
        {"relief-bake convert a.png b.png --input-flat=middle",
         "relief-bake: error: --input-flat: is now called --input-zero-code (give "
         "--input-zero-code 127.5 for half, 128 for middle)"},
        {"relief-mesh process a.obj b.obj --flat",
         "relief-mesh: error: --flat: unknown option (see relief-mesh process --help)"},
        {"relief-mesh process a.obj b.obj -x",
         "relief-mesh: error: -x: unknown option (see relief-mesh process --help)"},
        {"relief-mesh process a.obj b.obj --normals",
         "relief-mesh: error: --normals: needs a value (see relief-mesh process "
         "--help)"},
        {"relief-mesh process a.obj b.obj --normals --quiet",
         "relief-mesh: error: --normals: needs a value (see relief-mesh process "
         "--help)"},
        {"relief-mesh process a.obj b.obj --normals round",
         "relief-mesh: error: --normals round: not one of keep, flat, auto, uniform, "
         "area, angle, sine, max, angle-edges, area-angle (see "
         "relief-mesh process --help)"},
        {"relief-mesh process a.obj b.obj --threads 0",
         "relief-mesh: error: --threads 0: not between 1 and 1024 (see relief-mesh "
         "process --help)"},
        {"relief-bake bump a.png b.png --strength 1 --strength 2",
         "relief-bake: error: --strength: given more than once (see relief-bake bump "
         "--help)"}};
    for (const WrongUsage& row : rows) {
        const ProgramResult result = workplace.run(row.line);
        EXPECT_EQ(result.exit_code, 2) << row.line;
        EXPECT_EQ(result.error, std::string(row.error) + "\n") << row.line;
        EXPECT_EQ(result.out, "") << row.line;
    }
}

TEST(AllToolsAlike, PrintOnlyTheirVersion) {
    const Workplace workplace;
    for (const char* tool : {"relief-mesh", "relief-bake", "relief-view"}) {
        const ProgramResult result = workplace.run(std::string(tool) + " --version");
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.out, std::string(tool) + " " + version_and_commit() + "\n");
        EXPECT_EQ(result.error, "");
    }
}

TEST(AllToolsAlike, FailWhenTheirResultCannotBePrinted) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const ProgramResult result = workplace.run("relief-mesh info square.obj > /dev/full");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error, "relief-mesh: error: standard output: cannot be written\n");
    EXPECT_EQ(workplace.run("relief-mesh process --help > /dev/full").exit_code, 1);
    EXPECT_EQ(workplace.run("relief-mesh --version > /dev/full").exit_code, 1);
}

TEST(AllToolsAlike, SucceedWhenOnlyTheSummaryOfTheirFilesCannotBePrinted) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    const std::string warning =
        "relief-mesh: warning: standard output: cannot be written (the output files are "
        "complete)\n";
    for (const char* stream : {"> /dev/full", ">&-"}) {
        const ProgramResult result = workplace.run(
            std::string("relief-mesh process square.obj out/a.glb --report out/a.json ") + stream);
        EXPECT_EQ(result.exit_code, 0) << stream;
        EXPECT_EQ(result.error, warning);
        EXPECT_EQ(workplace.outputs(), "a.glb a.json");
        std::filesystem::remove(workplace / "out/a.json");
    }
    // A report on standard output is a result.
    const ProgramResult report =
        workplace.run("relief-mesh process square.obj out/a.glb --report - > /dev/full");
    EXPECT_EQ(report.exit_code, 1);
    EXPECT_EQ(report.error,
              "relief-mesh: error: standard output: cannot be written (the output files are "
              "complete)\n");
    EXPECT_EQ(workplace.run("relief-mesh --help-json > /dev/full").exit_code, 1);
}

TEST(AllToolsAlike, ReadImagesOnManyProcessorsAndWithLargeStacks) {
    const Workplace workplace;
    for (const char* name : {"n.exr", "n.tif"}) {
        Image flat = make_image(8, 8, 3, 32, ColorSpace::data);
        for (std::size_t i = 0; i < flat.sample_count(); ++i)
            flat.as<float>()[i] = i % 3 == 2 ? 1.0F : 0.0F;
        write_image(workplace / name, flat);
        for (const char* setting :
             {"OPENIMAGEIO_THREADS=256", "ulimit -s 65536; OPENIMAGEIO_THREADS=64"}) {
            const ProgramResult result =
                workplace.run(std::string(setting) + " relief-bake check " + name);
            EXPECT_EQ(result.exit_code, 0) << setting << ' ' << name << result.error;
        }
    }
}

TEST(AllToolsAlike, ReturnTheirCodeWhenTheErrorCannotBePrinted) {
    const Workplace workplace;
    workplace.write("bad.obj", "f 1 2 3\n");
    EXPECT_EQ(workplace.run("relief-mesh info bad.obj 2>&-").exit_code, 1);
    EXPECT_EQ(workplace.run("relief-mesh info bad.obj >&- 2>&-").exit_code, 1);
    EXPECT_EQ(workplace.run("relief-mesh info bad.obj 2> /dev/full").exit_code, 1);
}

TEST(AllToolsAlike, EscapeControlCharactersOfModels) {
    const Workplace workplace;
    workplace.write("a.obj", "o x\x1B[2J\x07y\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const ProgramResult result = workplace.run("relief-mesh info a.obj");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, testing::HasSubstr("x\\x1b[2J\\x07y"));
    EXPECT_THAT(result.out, testing::Not(testing::HasSubstr("\x1B")));
}

TEST(AllToolsAlike, EscapeControlCharactersOfFileNames) {
    const Workplace workplace;
    for (const std::string name : {"a\x1B[2J", "b\xC2\x9B", "c\xE4"}) {
        workplace.write_square(name + ".obj");
        std::filesystem::copy_file(workplace / "data/bricks-height.png",
                                   workplace / (name + ".png"));
    }
    for (const char* command :
         {"relief-mesh info a*.obj", "relief-mesh process *.obj -o out/", "relief-mesh check *.obj",
          "relief-bake check *.png", "relief-bake bump *.png -o out/",
          "relief-bake convert *.png -o out/", "relief-accuracy own *.obj --no-times",
          "relief-view a*.obj --output view.png --size 16x16 --explain-effects"}) {
        const ProgramResult result = workplace.run(command);
        const std::string text = result.out + result.error;
        EXPECT_THAT(text, testing::HasSubstr("a\\x1b[2J")) << command;
        for (const char* raw : {"\x1B", "\xC2\x9B", "c\xE4"})
            EXPECT_THAT(text, testing::Not(testing::HasSubstr(raw))) << command;
    }
}

TEST(AllToolsAlike, NameTheFileThatTheSystemRefuses) {
    const Workplace workplace;
    workplace.write_square("square.obj");
    std::filesystem::create_symlink("loop.obj", workplace / "loop.obj");
    for (const char* command :
         {"relief-mesh info loop.obj", "relief-mesh process square.obj loop.obj",
          "relief-mesh process loop.obj square.obj -o out/", "relief-view loop.obj --output a.png",
          "relief-mesh material square.obj a.gltf --normal loop.obj"}) {
        const ProgramResult result = workplace.run(command);
        EXPECT_EQ(result.exit_code, 1) << command;
        EXPECT_THAT(result.error, testing::HasSubstr("error: loop.obj: ")) << command;
        EXPECT_THAT(result.error, testing::HasSubstr("Too many levels of symbolic links"))
            << command;
    }
    const ProgramResult lost = workplace.run(
        "model=$PWD/square.obj; mkdir gone; cd gone; rmdir ../gone; "
        "relief-mesh process \"$model\" b.gltf");
    EXPECT_EQ(lost.exit_code, 1);
    EXPECT_EQ(lost.error,
              "relief-mesh: error: b.gltf: cannot be written: No such file or directory\n");
}

TEST(AllToolsAlike, StoreNamesThatAreNotUtf8OrRefuseThem) {
    const Workplace workplace;
    const std::string name = "b\xE4r";
    workplace.write(name + ".mtl", "newmtl a\nmap_Kd " + name + ".png\n");
    workplace.write(name + ".obj", "mtllib " + name +
                                       ".mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                       "usemtl a\nf 1/1 2/2 3/3\n");
    std::filesystem::copy_file(workplace / "data/bricks-diffuse.png", workplace / (name + ".png"));
    const ProgramResult processed = workplace.run("relief-mesh process b*r.obj a.gltf");
    EXPECT_EQ(processed.exit_code, 0) << processed.error;
    EXPECT_THAT(processed.out, testing::HasSubstr("name that is not UTF-8 (image 0)"));
    EXPECT_THAT(workplace.read("a.gltf"), testing::HasSubstr("\"b\xC3\xA4r\""));
    const ProgramResult stored =
        workplace.run("relief-mesh material a.gltf c.gltf --assume normal --normal b*r.png");
    EXPECT_EQ(stored.exit_code, 0) << stored.error;
    EXPECT_THAT(stored.out, testing::HasSubstr("name that is not UTF-8 (image 1)"));
    EXPECT_THAT(workplace.read("c.gltf"), testing::HasSubstr("\"uri\": \"b%E4r.png\""));
    EXPECT_EQ(workplace.run("relief-mesh check c.gltf").exit_code, 0);
    const ProgramResult scene =
        workplace.run("relief-view b*r.obj --output view.png --size 16x16 --save-scene scene.json");
    EXPECT_EQ(scene.exit_code, 1);
    EXPECT_THAT(scene.error, testing::HasSubstr("a scene file cannot name b\\xe4r.obj"));
}

TEST(Command, NamesTheFileInComplaintsAboutItsContents) {
    try {
        about("a.obj", [] { throw InvalidInput("triangle 7 names vertex 12"); });
        FAIL() << "did not throw";
    } catch (const FileError& error) {
        EXPECT_STREQ(error.what(), "a.obj: triangle 7 names vertex 12");
    }
    EXPECT_EQ(about("a.obj", [] { return 3; }), 3);
}

TEST(Command, StagesOfOneNameAreAddedUpInOrderOfFirstAppearance) {
    Stages stages(true);
    stages.run("read", [] {});
    EXPECT_EQ(stages.run("write", [] { return 5; }), 5);
    stages.run("read", [] {});
    EXPECT_THAT(stages.finished(),
                ElementsAre(Field(&Stage::name, "read"), Field(&Stage::name, "write")));
    EXPECT_GE(stages.milliseconds("read"), 0);
    EXPECT_EQ(stages.milliseconds("fly"), 0);
}

TEST(Command, AStageThatThrowsIsBookedAndThrowsOn) {
    Stages stages(true);
    EXPECT_THROW(stages.run("read", [] { throw std::runtime_error("x"); }), std::runtime_error);
    EXPECT_EQ(stages.finished().size(), 1U);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

void expect_form(const std::string& command, const std::vector<std::string>& lines) {
    ASSERT_GT(lines.size(), 4U);
    EXPECT_TRUE(lines[0].ends_with('.')) << lines[0];
    EXPECT_EQ(lines[1], "");
    EXPECT_THAT(lines[2], StartsWith("Usage: " + command));
    const auto examples = std::find(lines.begin(), lines.end(), "Examples:");
    for (auto line = lines.begin(); line != examples; ++line)
        EXPECT_LE(line->size(), 100U) << *line;
}

/// Expects that the text of each option begins in column 30, on the same line or on the next.
void expect_described_options(const std::vector<std::string>& lines) {
    std::size_t options = 0;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        if (!lines[i].starts_with("  --")) continue;
        ++options;
        const std::string& text =
            lines[i].size() > 30 && lines[i][29] == ' ' ? lines[i] : lines[i + 1];
        EXPECT_TRUE(text.size() > 30 && text[29] == ' ' && text[30] != ' ') << lines[i];
    }
    EXPECT_GT(options, 0U);
}

TEST(HelpPage, IsOneSentenceThenUsageAndDescribesEveryOption) {
    const Workplace workplace;
    const std::vector<std::string> commands = test::commands_with_help(workplace);
    EXPECT_THAT(commands, Contains("relief-view"));
    EXPECT_THAT(commands, Contains("relief-bake convert"));
    EXPECT_GE(commands.size(), 20U);
    for (const std::string& command : commands) {
        SCOPED_TRACE(command);
        const ProgramResult result = workplace.run(command + " --help");
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.error, "");
        expect_form(command, lines_of(result.out));
        expect_described_options(lines_of(result.out));
        const bool has_commands = result.out.find("\nCommands:\n") != std::string::npos;
        EXPECT_TRUE(has_commands || test::examples_of(result.out).size() >= 2U);
    }
}

}  // namespace
}  // namespace relief::tools
