// SPDX-License-Identifier: Apache-2.0
// Runs relief-bake mesh --shard and relief-bake merge.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// The report without what differs from run to run.
json lasting(const Workplace& workplace, const std::string& report) {
    json all = json::parse(workplace.read(report));
    all.erase("milliseconds");
    all.erase("stages");
    all.erase("times");
    all.erase("rays_per_second");
    return all;
}

/// Bakes the shards of a command line, the last one first.
void bake_shards(const Workplace& workplace, const std::string& line, int count) {
    for (int shard = count; shard > 0; --shard) {
        const ProgramResult result =
            workplace.run(fmt::format("{} --shard {}/{} --quiet", line, shard, count));
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
}

/// Bakes a command line at once and in shards, and compares all files.
void expect_equal(const Workplace& workplace, const std::string& line, int count) {
    SCOPED_TRACE(line);
    const ProgramResult whole = workplace.run(line + " --report report.json");
    ASSERT_EQ(whole.exit_code, 0) << whole.error;
    ASSERT_EQ(workplace.run("mv out whole && mkdir out").exit_code, 0);
    bake_shards(workplace, line, count);
    const ProgramResult merged =
        workplace.run("relief-bake merge out/*.part --report merged.json --threads 2");
    ASSERT_EQ(merged.exit_code, 0) << merged.error;
    EXPECT_EQ(workplace.run("diff -r whole out").out, "");
    EXPECT_EQ(lasting(workplace, "merged.json"), lasting(workplace, "report.json"));
    ASSERT_EQ(workplace.run("rm -r whole out && mkdir out").exit_code, 0);
}

TEST(BakeMerge, HasTheBytesOfOneBakeInEveryLayer) {
    const Workplace workplace;
    const std::string line =
        "relief-bake mesh data/urn-high.ply data/urn-low.obj out/map.png --size 72x150 --samples 4 "
        "--height-map out/h.png --occlusion-map out/o.png --occlusion-rays 4 --curvature-map "
        "out/c.png --position-map out/p.png --color-map out/k.png --bent-normal-map out/b.png "
        "--thickness-map out/t.tif --thickness-rays 4 --id-map out/i.png ";
    expect_equal(workplace, line + "--layer-bits 16 --background transparent", 16);
    expect_equal(workplace,
                 "relief-bake mesh data/urn-high.ply data/urn-low.obj out/map.ktx2 --size 64 "
                 "--samples auto --padding border --green down --rays shading --max-missed 90",
                 3);
}

TEST(BakeMerge, MakesTheMapsOfMaterialsAndTilesAndStoresThemInAModel) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh subdivide data/vase.obj high.obj --levels 1").exit_code,
              0);
    expect_equal(workplace,
                 "relief-bake mesh high.obj data/vase.obj 'out/<material>-<UDIM>.png' --size 32 "
                 "--dither ordered --bits 8",
                 5);
    expect_equal(workplace,
                 "relief-bake mesh high.obj data/vase.obj out/map.png --size 32 --write-into "
                 "out/vase.glb",
                 2);
}

/// Parts 1 to 3 of a small bake in parts/, and the map that they make.
class Parts {
  public:
    Parts() {
        workplace.write_square("low.obj");
        workplace.write_square("high.obj", true);
        workplace.write("other.obj", workplace.read("low.obj"));
        EXPECT_EQ(workplace.run(line("out/map.png") + " && mkdir parts").exit_code, 0);
        map = workplace.read("out/map.png");
        for (const char* shard : {"1", "2", "3"}) {
            EXPECT_EQ(workplace
                          .run(line("out/map.png") +
                               fmt::format(" --shard {0}/3 --part parts/{0}", shard))
                          .exit_code,
                      0);
        }
    }

    static std::string line(const std::string& out) {
        return "relief-bake mesh high.obj low.obj " + out + " --size 64 --id-map out/id.png";
    }

    Workplace workplace;
    std::string map;
};

TEST(BakeMerge, RefusesMixedRepeatedMissingAndDamagedParts) {
    const Parts parts;
    const Workplace& workplace = parts.workplace;
    const std::string line = Parts::line("out/map.png");
    ASSERT_EQ(workplace.run(line + " --padding 3 --shard 2/3 --part parts/padded").exit_code, 0);
    ASSERT_EQ(workplace.run(line + " --shard 2/4 --part parts/four").exit_code, 0);
    workplace.write("high.obj", workplace.read("high.obj") + "\n# changed\n");
    ASSERT_EQ(workplace.run(line + " --shard 2/3 --part parts/changed").exit_code, 0);
    workplace.write("parts/short", workplace.read("parts/2").substr(0, 900));
    workplace.write("parts/text", "a text");
    std::string damaged = workplace.read("parts/2");
    damaged[200] = static_cast<char>(damaged[200] ^ 1);
    workplace.write("parts/damaged", damaged);
    ASSERT_EQ(workplace.run("rm out/*").exit_code, 0);
    expect_refusals(
        workplace, "relief-bake", "map.png",
        {{"merge", 2, "PART: is missing"},
         {"merge parts/1 parts/2", 1, "parts/1: 1 of 3 parts is missing: 3 (bake them with"},
         {"merge parts/3", 1, "parts/3: 2 of 3 parts are missing: 1, 2"},
         {"merge parts/3 parts/2 parts/3 parts/1", 1, "parts/3: is part 3 of 3, as parts/3 is"},
         {"merge parts/1 parts/padded parts/3", 1,
          "parts/padded: belongs to another bake than parts/1: the options or files differ"},
         {"merge parts/1 parts/four parts/3", 1,
          "parts/four: belongs to another bake than parts/1: one is of 3 parts, one of 4"},
         {"merge parts/1 parts/changed parts/3", 1,
          "parts/changed: belongs to another bake than parts/1: the contents of high.obj differ"},
         {"merge parts/1 parts/short parts/3", 1, "parts/short: is damaged: its end is missing"},
         {"merge parts/1 parts/text parts/3", 1, "parts/text: is not a part of a bake"},
         {"merge parts/1 parts/damaged parts/3", 1, "parts/damaged: is damaged: the hash of rows"},
         {"merge parts/1 parts/none parts/3", 1, "parts/none: "},
         {"merge parts/1 parts/2 parts/3 -o parts/1", 2, "parts/1: "}});
    const ProgramResult merged = workplace.run(
        "relief-bake merge parts/2 parts/3 parts/1 -o out/other.png --keep && ls parts");
    EXPECT_EQ(merged.exit_code, 0) << merged.error;
    EXPECT_THAT(merged.out, HasSubstr("1\n2\n3\n"));
    EXPECT_EQ(workplace.read("out/other.png"), parts.map);
}

TEST(BakeMerge, NoByteOfAPartCanBeDamagedUnnoticed) {
    const Parts parts;
    const Workplace& workplace = parts.workplace;
    const std::string part = workplace.read("parts/2");
    for (std::size_t at = 0; at < part.size(); at += part.size() / 40) {
        std::string damaged = part;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
        workplace.write("parts/2", damaged);
        const ProgramResult result =
            workplace.run("relief-bake merge parts/1 parts/2 parts/3 --keep --quiet");
        EXPECT_EQ(result.exit_code, 1) << at;
        EXPECT_THAT(result.error, HasSubstr("parts/2: is")) << at;
    }
    EXPECT_EQ(workplace.read("out/map.png"), parts.map);
}

TEST(BakeShard, IsNamedByItsJobAndCanBeRepeated) {
    const Parts parts;
    const Workplace& workplace = parts.workplace;
    const std::string line = Parts::line("'out/a b.png'") + " --shard 2/3";
    const ProgramResult first = workplace.run(line);
    ASSERT_EQ(first.exit_code, 0) << first.error;
    EXPECT_THAT(first.out, HasSubstr("2 of 3, job "));
    const std::string name = workplace.run("ls out/*.part").out;
    EXPECT_THAT(name, testing::MatchesRegex("out/a b\\.png\\.[0-9a-f]{16}-2-of-3\\.part\n"));
    ASSERT_EQ(workplace.run(line + " --threads 1 --quiet").exit_code, 0);
    EXPECT_EQ(workplace.run("ls out/*.part").out, name);
    // Another option is another job.
    ASSERT_EQ(workplace.run(line + " --samples 4").exit_code, 0);
    EXPECT_EQ(workplace.run("ls out/*.part | wc -l").out, "2\n");
}

TEST(BakeShard, RefusesOptionsThatNeedTheWholeMap) {
    const Parts parts;
    const std::string line = "mesh high.obj low.obj out/map.png --size 64 ";
    ASSERT_EQ(parts.workplace.run("rm out/*").exit_code, 0);
    expect_refusals(
        parts.workplace, "relief-bake", "map.png",
        {{line + "--shard 0/3", 2, "--shard 0/3: "},
         {line + "--shard 4/3", 2, "--shard 4/3: "},
         {line + "--shard 3", 2, "--shard 3: is not K/N (write 3/16)"},
         {line + "--shard 1/2/3", 2, "--shard 1/2/3: is not K/N"},
         {line + "--part x", 2, "--part: has no effect without --shard"},
         {line + "--shard 1/2 --part low.obj", 2, "--part low.obj: is also"},
         {line + "--shard 1/2 --verify", 2, "--verify, --shard: contradict each other"},
         {line + "--shard 1/2 --compare", 2, "--compare, --shard: contradict each other"},
         {line + "--shard 1/2 --max-error 1", 2, "--max-error, --shard: contradict each other"},
         {line + "--shard 1/2 --preview out/p.png", 2, "--preview, --shard: contradict"},
         {"mesh a_high.obj a_low.obj -o out/ --shard 1/2", 2, "-o, --shard: contradict"}});
}

}  // namespace
}  // namespace relief::tools
