// SPDX-License-Identifier: Apache-2.0
// Tools that run in the test's own process: which lines do, and that they do what the programs do.
// Each command of each tool runs once as a program here.
#include "tools/linked_tools.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::test {
namespace {

using testing::ElementsAre;
using testing::Optional;

TEST(PlainWords, AreThoseThatAShellPassesOn) {
    EXPECT_THAT(plain_text("relief-mesh info a.obj"),
                Optional(ElementsAre("relief-mesh", "info", "a.obj")));
    EXPECT_THAT(plain_text("  a   'b c'd \"e  f\" '' 'g\"h' --i=j "),
                Optional(ElementsAre("a", "b cd", "e  f", "", "g\"h", "--i=j")));
    EXPECT_THAT(plain_text("a '*' '$b' \"c;\""), Optional(ElementsAre("a", "*", "$b", "c;")));
    for (const char* line :
         {"a | b", "a > b", "a; b", "a && b", "a $b", "a \"$b\"", "a *.obj", "a `b`", "a \\ b",
          "A=b c", "a 'b", "", "a\nb", "(a)", "a # b", "a ~/b", "a ?", "a [b]"})
        EXPECT_EQ(plain_text(line), std::nullopt) << line;
}

/// The output of a command line, and the files that it left in out/.
struct Outcome {
    ProgramResult result;
    std::vector<std::string> files;
};

Outcome outcome_of(const Workplace& workplace, const ProgramResult& result) {
    Outcome outcome{result, {}};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(workplace / "out")) {
        if (!entry.is_regular_file()) continue;
        const std::filesystem::path file = entry.path().lexically_relative(workplace / "");
        outcome.files.push_back(file.string() + ":" + workplace.read(file));
    }
    std::sort(outcome.files.begin(), outcome.files.end());
    return outcome;
}

TEST_LABELS(slow, not_sanitized);
TEST(LinkedTools, BehaveLikeThePrograms) {
    const Workplace linked;
    const Workplace programs;
    linked.shrink_bricks();
    programs.shrink_bricks();
    for (const char* line :
         {"relief-mesh process data/vase.obj out/vase.glb --tangents mikktspace --quiet",
          "relief-mesh decimate data/vase.obj out/low.obj --triangles 1000 --quiet",
          "relief-mesh subdivide data/vase.obj out/high.obj --quiet",
          "relief-mesh info out/vase.glb --json",
          "relief-mesh check data/scenes/knot.glb --for-baking --strict",
          "relief-mesh compare out/vase.glb out/low.obj --max-angle 5 --strict --json",
          "relief-mesh conformance conformance/kit --quiet",
          "relief-bake bump data/bricks-height.png out/normals.png --strength 12 --quiet",
          "relief-bake convert out/normals.png out/dx.png --flip green --quiet",
          "relief-bake heights out/normals.png out/heights.png --quiet",
          "relief-bake check out/dx.png --strict --quiet",
          "relief-bake mesh out/high.obj out/low.obj out/baked.png --size 64 --quiet --threads 1",
          "relief-view out/vase.glb --output out/vase.png --size 64x64 --quiet",
          "relief-accuracy run storage --quick --no-times --json --quiet",
          "relief-accuracy own data/vase.obj --quick --no-times --quiet --output out/own",
          "relief-accuracy report out/own/accuracy.json --output out/page.html --quiet",
          "relief-accuracy compare out/own/accuracy.json out/own/accuracy.json",
          "relief-mesh --version",
          "relief-bake mesh --help",
          "relief-view --list-bindings",
          "relief-bake bump a b",
          "relief-accuracy none"}) {
        SCOPED_TRACE(line);
        const Outcome expected = outcome_of(programs, run_shell(line, programs / "."));
        const Outcome found = outcome_of(linked, linked.run(line));
        EXPECT_EQ(found.result.exit_code, expected.result.exit_code);
        EXPECT_EQ(found.result.out, expected.result.out);
        EXPECT_EQ(found.result.error, expected.result.error);
        EXPECT_TRUE(found.files == expected.files);
    }
}

TEST_LABELS(not_sanitized);
TEST(LinkedTools, LeaveTheWorkingDirectoryAndTheOldStreams) {
    const std::filesystem::path before = std::filesystem::current_path();
    const Workplace workplace;
    EXPECT_EQ(workplace.run("relief-mesh info missing.obj").exit_code, 1);
    EXPECT_EQ(workplace.run("relief-mesh info data/vase.obj").exit_code, 0);
    EXPECT_EQ(std::filesystem::current_path(), before);
}

}  // namespace
}  // namespace relief::test
