// SPDX-License-Identifier: Apache-2.0
// The command `relief check`: findings, exit codes, and names and files of any kind.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "check/planted_defects.h"
#include "support/labels.h"
#include "tools/linked_tools.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;
using testing::Not;

/// Returns the number of a planted kind.
std::size_t kind_of(const std::string& rule) {
    const auto& kinds = test::planted_kinds();
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i].rule == rule) return i;
    }
    throw std::out_of_range(rule);
}

class CheckCommand : public testing::Test {
  protected:
    void SetUp() override { fs::create_directory(workplace / "in"); }

    void plant(const std::string& name, const std::string& rule, int variant = 1) const {
        test::write_planted_model(workplace / "in", name, kind_of(rule), variant);
    }

    [[nodiscard]] json report(const std::string& more = "") const {
        return json::parse(workplace.run("relief check in --format json" + more).out);
    }

    Workplace workplace;
};

TEST_F(CheckCommand, ReportsRulesWithRemediesAndCounts) {
    plant("a", "");
    plant("b", "texture/green-down");
    plant("c", "mesh/repeated-triangle");
    const ProgramResult result = workplace.run("relief check in");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out,
                HasSubstr("in/b_normal.png: error: green is down: as in DirectX; OpenGL and glTF "
                          "have it up [texture/green-down]\n    -> relief-bake convert "
                          "in/b_normal.png out.png --flip green\n"));
    EXPECT_THAT(result.out, HasSubstr("in/c.gltf: warning: mesh 0 primitive 0: 1 x repeated "
                                      "triangle (triangle 98): is equal to an earlier triangle "
                                      "and counts twice [mesh/repeated-triangle]\n    -> "
                                      "relief-mesh repair in/c.gltf out.gltf\n"));
    EXPECT_THAT(result.out, HasSubstr("in all    9 files: 1 error, 1 warning, "));
    EXPECT_THAT(result.out, Not(HasSubstr("boundary edge")));
    EXPECT_THAT(workplace.run("relief check in --notes").out,
                HasSubstr("note: mesh 0 primitive 0: "));
    const ProgramResult strict = workplace.run("relief check in --strict --quiet");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.out, "");
    EXPECT_EQ(strict.error,
              "relief: warning: 2 errors or warnings (exit code 3, because of --strict)\n");
    EXPECT_EQ(workplace.run("relief check in/a.gltf --strict").exit_code, 0);
}

TEST_F(CheckCommand, ChecksTheImagesOfASingleModel) {
    plant("b", "texture/green-down");
    EXPECT_THAT(workplace.run("relief check in/b.gltf").out,
                HasSubstr("in/b_normal.png: error: green is down"));
}

TEST_F(CheckCommand, GoesOnAfterABrokenFile) {
    plant("a", "mesh/repeated-triangle");
    workplace.write("in/0.glb", "no model");
    workplace.write("in/z.png", "no image");
    const ProgramResult result = workplace.run("relief check in --format json --strict");
    EXPECT_EQ(result.exit_code, 1);
    const json report = json::parse(result.out);
    EXPECT_EQ(report["unreadable"], 2);
    EXPECT_EQ(report["errors"], 2);
    EXPECT_EQ(report["warnings"], 1);
    EXPECT_EQ(report["files"][0]["file"], "in/0.glb");
    EXPECT_EQ(report["files"][0]["unreadable"], true);
    EXPECT_EQ(report["files"][0]["findings"][0]["rule"], "file/unreadable");
}

TEST_F(CheckCommand, JudgesMapsByTheirNamesWithoutAModel) {
    plant("b", "texture/green-down");
    fs::create_directory(workplace / "maps");
    fs::copy_file(workplace / "in/b_normal.png", workplace / "maps/rock_normalgl.png");
    fs::copy_file(workplace / "in/b_normal.png", workplace / "maps/rock_roughness.png");
    fs::copy_file(workplace / "in/b_normal.png", workplace / "maps/rock_normaldx.png");
    const json report = json::parse(workplace.run("relief check maps --format json").out);
    std::map<std::string, std::set<std::string>> alarms;
    for (const json& file : report["files"]) {
        for (const json& finding : file["findings"]) {
            if (finding["severity"] != "note") alarms[file["file"]].insert(finding["rule"]);
        }
    }
    EXPECT_EQ(alarms, (std::map<std::string, std::set<std::string>>{
                          {"maps/rock_normalgl.png", {"map/green-contradicted"}},
                          {"maps/rock_roughness.png", {"map/contradicts-name"}}}));
}

TEST_F(CheckCommand, PairsAMeshWithItsMaps) {
    plant("b", "texture/green-down");
    workplace.write_square("in/rock.obj", true);
    fs::copy_file(workplace / "in/b_normal.png", workplace / "in/rock_normal.png");
    EXPECT_THAT(workplace.run("relief check in").out,
                HasSubstr("in/rock.obj: error: has no texture coordinates, but 1 texture "
                          "[model/missing-texcoords]"));
}

TEST_F(CheckCommand, AcceptsAnEmptyFolder) {
    const ProgramResult result = workplace.run("relief check in --strict");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr("in all    0 files: 0 errors, 0 warnings, 0 notes\n"));
}

TEST_F(CheckCommand, TakesFileNamesOfAnyKind) {
    const std::vector<std::string> names = {"-x",          "it's \"quoted\"", "two words",
                                            "line\nbreak", "$(touch pwned)",  "caf\xE9",
                                            "percent%20"};
    for (const std::string& name : names)
        plant(name, "mesh/repeated-triangle");
    const ProgramResult result = workplace.run("relief check in --format json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["warnings"], names.size());
    EXPECT_EQ(report["errors"], 0);
    for (const char* format : {"text", "sarif", "junit", "github"}) {
        const ProgramResult other =
            workplace.run(std::string("relief check in --format ") + format);
        EXPECT_EQ(other.exit_code, 0);
        EXPECT_THAT(other.out, Not(HasSubstr("line\nbreak")));
    }
    // A name of a line begins with a dash.
    const ProgramResult inside =
        test::run_shell("relief check . ./-x.gltf --format text", workplace / "in");
    EXPECT_EQ(inside.exit_code, 0) << inside.error;
    EXPECT_FALSE(fs::exists(workplace / "pwned"));
}

TEST_F(CheckCommand, ReportsWhatCannotBeRead) {
    if (::geteuid() != 0) {
        fs::create_directory(workplace / "in/closed");
        fs::permissions(workplace / "in/closed", fs::perms::none);
    }
    fs::create_symlink("loop.glb", workplace / "in/loop.glb");
    fs::create_symlink("gone.png", workplace / "in/lost.png");
    ASSERT_EQ(::mkfifo((workplace / "in/pipe.png").c_str(), 0600), 0);
    ASSERT_EQ(::mkfifo((workplace / "in/pipe.glb").c_str(), 0600), 0);
    const json report = this->report();
    EXPECT_EQ(report["unreadable"], ::geteuid() != 0 ? 5 : 4);
    EXPECT_EQ(report["errors"], report["unreadable"]);
    const ProgramResult missing = workplace.run("relief check in/none.glb");
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.out, HasSubstr("in/none.glb: error: "));
    if (::geteuid() != 0) fs::permissions(workplace / "in/closed", fs::perms::owner_all);
}

TEST_F(CheckCommand, ReportsEachLinkToAnImage) {
    plant("b", "texture/green-down");
    fs::create_symlink("b_normal.png", workplace / "in/a.png");
    const std::string out = workplace.run("relief check in").out;
    EXPECT_THAT(out, HasSubstr("in/a.png: error: green is down"));
    EXPECT_THAT(out, HasSubstr("in/b_normal.png: error: green is down"));
    EXPECT_THAT(out, HasSubstr("in all    4 files: 2 errors"));
}

TEST_F(CheckCommand, PrintsResultsIfTheCacheCannotBeWritten) {
    plant("a", "mesh/repeated-triangle");
    fs::create_directory(workplace / "out/cache");
    const ProgramResult result = workplace.run("relief check in --cache out/cache");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, HasSubstr("[mesh/repeated-triangle]"));
    EXPECT_THAT(result.error, HasSubstr("relief: error: out/cache: "));
}

TEST_F(CheckCommand, GivesTheSameForAnyNumberOfThreads) {
    for (int variant = 0; variant < 4; ++variant)
        plant(fmt::format("v{}", variant), "mesh/flipped-neighbors", variant);
    EXPECT_EQ(workplace.run("relief check in --notes --threads 1").out,
              workplace.run("relief check in --notes --threads 4").out);
}

// action.yml calls this script.
TEST_F(CheckCommand, RunsInAWorkflow) {
    plant("a", "mesh/repeated-triangle");
    const ProgramResult result = workplace.run(
        "RELIEF_PATHS='in/*.gltf' RELIEF_OPTIONS=--strict GITHUB_ACTIONS=true "
        "scripts/dev/check-assets");
    EXPECT_EQ(result.exit_code, 3) << result.error;
    EXPECT_THAT(result.out, HasSubstr("::warning file=in/a.gltf,title=mesh/repeated-triangle::"));
    const ProgramResult text = workplace.run("RELIEF_PATHS=in scripts/dev/check-assets");
    EXPECT_EQ(text.exit_code, 0) << text.error;
    EXPECT_THAT(text.out, HasSubstr("in/a.gltf: warning: "));
}

// The outputs of relief have no defects.
TEST_F(CheckCommand, AcceptsTheAssetsThatReliefMakes) {
    for (const char* line :
         {"relief make data/vase.obj in/vase.gltf --triangles 300 --size 64 --padding 2 "
          "--occlusion-rays 2 --quiet",
          "relief-bake bump data/bricks-height.png in/bricks_normal.png --quiet"}) {
        const ProgramResult made = workplace.run(line);
        ASSERT_EQ(made.exit_code, 0) << made.error;
    }
    const ProgramResult result = workplace.run("relief check in --strict");
    EXPECT_EQ(result.exit_code, 0) << result.out;
}

TEST_F(CheckCommand, RefusesContradictions) {
    test::expect_refusals(
        workplace, "relief", "x.glb",
        {{"check", 2, "PATH: is missing"},
         {"check in --quiet --format json", 2, "--format and --quiet contradict each other"},
         {"check in -o out", 2, "--output"},
         {"check in --fix", 2, "--fix: needs either a folder for copies or --in-place"},
         {"check in --fix --in-place -o out", 2, "--fix: needs either"},
         {"check in --fix --in-place --write-baseline", 2, "--fix, --write-baseline: contradict"},
         {"check in --cache in/a.png", 2, "--cache in/a.png: is the name of a model or an image"},
         {"check in --report out/x.pdf", 2,
          "--report out/x.pdf: .pdf is not the extension of a report"},
         {"check in --report in/relief.json", 2, "--report in/relief.json: "},
         {"check in --cache out/a.json --report out/a.json", 2, "--report out/a.json: "},
         {"check in --config none.json", 1, "none.json: "},
         {"check data/README.md", 2,
          "data/README.md: is neither a folder nor a model or an image"}});
}

}  // namespace
}  // namespace relief::tools
