// SPDX-License-Identifier: Apache-2.0
// Shards of relief check: the merged reports are those of one run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "check/planted_defects.h"
#include "check_part.h"
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

class CheckShards : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(workplace / "in/maps");
        fs::create_directory(workplace / "parts");
    }

    void plant(const std::string& name, std::size_t kind) const {
        test::write_planted_model(workplace / "in", name, kind, 1);
    }

    /// Runs all shards, the last one first. \return their parts for a command line
    std::string run_shards(const std::string& options, int count) const {
        for (int shard = count; shard >= 1; --shard) {
            const ProgramResult result = workplace.run(
                fmt::format("relief check {0} --shard {1}/{2} --part parts/{1}.part --threads {3}",
                            options, shard, count, 1 + shard % 2));
            EXPECT_EQ(result.exit_code, 0) << result.error;
            EXPECT_EQ(result.out.find(fmt::format("part      parts/{}.part\n", shard)),
                      options.find("--format json") == std::string::npos ? 0 : std::string::npos);
        }
        return "parts/*.part";
    }

    Workplace workplace;
};

// A model of each kind of defect, images without a model, files that cannot be read, and budgets.
TEST_F(CheckShards, GiveTheReportsOfOneRun) {
    for (std::size_t kind = 0; kind < test::planted_kinds().size(); ++kind)
        plant(test::planted_name(kind, 1), kind);
    fs::copy_file(workplace / "data/scenes/bricks-normal.png", workplace / "in/maps/a_rough.png");
    fs::copy_file(workplace / "data/scenes/bricks-normal.png", workplace / "in/maps/b_normal.png");
    fs::create_symlink("b_normal.png", workplace / "in/maps/link.png");
    fs::create_directory_symlink("maps", workplace / "in/again");
    workplace.write("in/caf\xE9 \"x\"\n.glb", "no model");
    workplace.write("in/broken.png", "no image");
    workplace.write("in/relief.json", R"({"exclude": "3-1*", "rules": {"mesh/*": "error"},
        "suppress": [{"rule": "texture/wrong-kind", "reason": "a test"}],
        "budgets": [{"files": "**", "triangles": 50, "map_size": 16, "memory": 5000,
                     "texel_density": [1, 2], "file_size": 3000}]})");
    const std::string options = "in --notes --strict";
    const std::string reports =
        " --report out/c.json --report out/c.sarif --report out/c.xml --report out/c.txt";
    const ProgramResult whole = workplace.run("relief check " + options + reports);
    EXPECT_EQ(whole.exit_code, 1);
    EXPECT_THAT(whole.out, HasSubstr("suppressed"));
    EXPECT_THAT(whole.out, HasSubstr("[budget/memory]"));
    fs::copy(workplace / "out", workplace / "whole");
    for (const int count : {1, 3, 40}) {
        SCOPED_TRACE(count);
        const std::string parts = run_shards(options + reports, count);
        const ProgramResult merged = workplace.run("relief merge --threads 2 " + parts);
        EXPECT_EQ(merged.exit_code, 1);
        EXPECT_EQ(merged.out, whole.out);
        EXPECT_EQ(merged.error, whole.error);
        EXPECT_EQ(workplace.run("diff -r whole out").out, "");
        // They stay if the exit code is 1.
        EXPECT_EQ(workplace.run("ls parts | wc -l; rm parts/*").out, fmt::format("{}\n", count));
    }
}

TEST_LABELS(gl);
TEST_F(CheckShards, GiveThePageOfOneRunAndRemoveTheirParts) {
    plant("a", 1);
    plant("b", 2);
    ASSERT_EQ(workplace.run("relief check in --report out/page.html").exit_code, 0);
    fs::rename(workplace / "out/page.html", workplace / "whole.html");
    const std::string parts = run_shards("in --report out/page.html", 2);
    EXPECT_FALSE(fs::exists(workplace / "out/page.html"));
    ASSERT_EQ(workplace.run("relief merge --keep --quiet " + parts).exit_code, 0);
    EXPECT_EQ(workplace.run("cmp whole.html out/page.html && ls parts").out, "1.part\n2.part\n");
    ASSERT_EQ(workplace.run("relief merge " + parts).exit_code, 0);
    EXPECT_EQ(workplace.run("ls parts").out, "");
}

// Only its model, which another shard checks, says that the image is a normal map.
TEST_F(CheckShards, JudgeImagesByTheUsesOfAllShards) {
    plant("b", 0);
    const std::string model = workplace.read("in/b.gltf");
    fs::copy_file(workplace / "data/bricks-diffuse.png", workplace / "in/x.png");
    json document = json::parse(model);
    document["images"].push_back({{"uri", "x.png"}});
    document["textures"].push_back({{"source", document["images"].size() - 1}});
    document["materials"][0]["normalTexture"] = {{"index", document["textures"].size() - 1}};
    workplace.write("in/b.gltf", document.dump());
    const ProgramResult whole = workplace.run("relief check in --format json");
    EXPECT_THAT(whole.out, HasSubstr("map/not-normals"));
    for (const int count : {2, 5}) {
        const std::string parts = run_shards("in --format json", count);
        EXPECT_EQ(workplace.run("relief merge " + parts).out, whole.out);
    }
}

TEST_F(CheckShards, HaveDefaultNamesOfTheirJob) {
    plant("a", 1);
    const ProgramResult one = workplace.run("relief check in --shard 1/2");
    const ProgramResult two = workplace.run("relief check in --shard 2/2");
    ASSERT_EQ(workplace.run("relief check in --notes --shard 2/2").exit_code, 0);
    EXPECT_EQ(workplace.run("ls relief-check.*-2-of-2.part | wc -l").out, "2\n");
    EXPECT_THAT(one.out, HasSubstr("-1-of-2.part\nchecked   1 model and "));
}

TEST_F(CheckShards, FixAndWriteBaselinesInTheMerge) {
    plant("a", 1);
    std::string parts = run_shards("in --write-baseline", 2);
    EXPECT_FALSE(fs::exists(workplace / "in/relief.json"));
    ASSERT_EQ(workplace.run("relief merge " + parts).exit_code, 0);
    EXPECT_EQ(json::parse(workplace.read("in/relief.json"))["baseline"].size(), 1U);
    EXPECT_THAT(workplace.run("relief check in").out, HasSubstr("1 in the baseline"));
}

TEST_F(CheckShards, RefusePartsThatDoNotBelongTogether) {
    plant("a", 1);
    plant("b", 2);
    const std::string parts = run_shards("in", 3);
    const auto refusal = [&](const std::string& files) {
        const ProgramResult result = workplace.run("relief merge " + files);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(result.out, "");
        return result.error;
    };
    EXPECT_EQ(refusal("parts/3.part parts/1.part"),
              "relief: error: parts/1.part: 1 of 3 parts is missing: 2 (check them with "
              "--shard)\n");
    EXPECT_THAT(
        refusal("parts/*.part parts/2.part"),
        HasSubstr("parts/2.part: is part 2 of 3, as parts/2.part is (give each part once)"));
    const auto other = [&](const std::string& options) {
        EXPECT_EQ(workplace.run("relief check " + options + " --part parts/2.part").exit_code, 0);
        return refusal(parts);
    };
    EXPECT_THAT(
        other("in --notes --shard 2/3"),
        HasSubstr("parts/2.part: belongs to another check than parts/1.part: the options or "
                  "files differ (give the parts of one check)"));
    EXPECT_THAT(other("in --shard 2/4"), HasSubstr("one is of 3 parts, one of 4"));
    workplace.write("in/new.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(other("in --shard 2/3"), HasSubstr("the contents of the checked folders differ"));
    fs::remove(workplace / "in/new.obj");
    workplace.write("in/relief.json", "{}");
    EXPECT_THAT(other("in --shard 2/3"), HasSubstr("the contents of in/relief.json differ"));
    fs::remove(workplace / "in/relief.json");
    EXPECT_EQ(workplace.run("relief check in --shard 2/3 --part parts/2.part").exit_code, 0);
    workplace.write("relief.json", "{}");
    EXPECT_THAT(refusal(parts), HasSubstr("relief.json: has changed since the shards ran"));
    fs::remove(workplace / "relief.json");
    EXPECT_EQ(workplace.run("relief merge " + parts).exit_code, 0);
}

TEST_F(CheckShards, RefuseDamagedParts) {
    plant("a", 1);
    const std::string parts = run_shards("in", 1);
    const std::string sound = workplace.read("parts/1.part");
    const auto refusal = [&](const std::string& text) {
        workplace.write("parts/1.part", text);
        const ProgramResult result = workplace.run("relief merge " + parts);
        EXPECT_EQ(result.exit_code, 1);
        return result.error;
    };
    std::string changed = sound;
    changed[sound.size() / 2] ^= 1;
    EXPECT_THAT(refusal(changed), HasSubstr("parts/1.part: is damaged: its hash differs (repeat "
                                            "its shard)"));
    EXPECT_THAT(refusal(sound.substr(0, sound.size() - 1)), HasSubstr("its hash differs"));
    EXPECT_THAT(refusal("relief part 1\n"),
                HasSubstr("is not a part of a check (relief check --shard writes parts)"));
    EXPECT_THAT(refusal(""), HasSubstr("is not a part of a check"));
    // Written by a program that lies about its share.
    workplace.write("parts/1.part", sound);
    CheckPart part = read_check_part(workplace / "parts/1.part");
    part.models.clear();
    write_part(workplace / "parts/1.part", part);
    EXPECT_THAT(workplace.run("relief merge " + parts).error,
                HasSubstr("parts/1.part: is damaged: it does not have its share of the models"));
}

TEST_F(CheckShards, RefuseContradictions) {
    test::expect_refusals(
        workplace, "relief", "c.html",
        {{"check in --shard 1/2 --cache out/c.json", 2, "--cache, --shard: contradict each other"},
         {"check in --part out/c.part", 2, "--part: has no effect without --shard"},
         {"check in --shard 3/2", 2, "--shard"},
         {"check in --shard 1/2 --rules", 2, "--rules: lists the rules and checks nothing"},
         {"merge", 2, "PART: is missing"},
         {"merge none.part", 1, "none.part"}});
}

TEST_F(CheckShards, AreTasksOfAFarm) {
    for (std::size_t kind = 0; kind < 6; ++kind)
        plant(test::planted_name(kind, 1), kind);
    const std::string options = "in --report out/c.json --quiet";
    ASSERT_EQ(workplace.run("relief check " + options).exit_code, 0);
    fs::rename(workplace / "out/c.json", workplace / "whole.json");
    workplace.write("jobs.json", R"({"jobs": [{"name": "all", "shards": 4, "command":
        ["check", "in", "--report", "out/c.json", "--quiet"]}]})");
    const ProgramResult lines = workplace.run("relief farm jobs.json");
    ASSERT_EQ(lines.exit_code, 0) << lines.error;
    EXPECT_THAT(lines.out, HasSubstr("check --shard=4/4 --part="));
    EXPECT_THAT(lines.out, HasSubstr("merge --threads=1 "));
    workplace.write("lines.sh", "PATH=$PWD/build/release/bin:$PATH\n" + lines.out);
    const ProgramResult run =
        test::run_program({"/bin/bash", (workplace / "lines.sh").string()}, workplace / "");
    EXPECT_EQ(run.exit_code, 0) << run.error;
    EXPECT_EQ(workplace.run("cmp whole.json out/c.json && find .relief-farm-* -name '*.part'").out,
              "");
}

}  // namespace
}  // namespace relief::tools
