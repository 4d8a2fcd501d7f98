// SPDX-License-Identifier: Apache-2.0
// The commands `relief-mesh repair` and `remesh`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::expect_refusals;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// Two cubes that share an edge; one is inside out and has a triangle twice.
constexpr const char* touching_cubes =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "v 2 1 0\nv 2 2 0\nv 1 2 0\nv 2 1 1\nv 2 2 1\nv 1 2 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    "f 3 9 10 11\nf 14 13 12 7\nf 7 12 9 3\nf 12 13 10 9\nf 13 14 11 10\nf 14 7 3 11\n"
    "f 1 2 6\n";

std::size_t count_after(const json& report, const std::string& kind) {
    for (const json& condition : report["conditions"]) {
        if (condition["kind"] == kind) return condition["after"];
    }
    return 0;
}

std::size_t findings_of(const json& report, const std::string& kind) {
    for (const json& finding : report["findings"]) {
        if (finding["kind"] == kind) return finding["count"];
    }
    return 0;
}

TEST(RepairCommand, CountsWhatItRepairsAndWhatCheckFindsBeforeAndAfter) {
    const Workplace workplace;
    workplace.write("cubes.obj", touching_cubes);
    const ProgramResult result =
        workplace.run("relief-mesh repair cubes.obj out/cubes.obj --report out/report.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("25 triangles"));
    EXPECT_THAT(result.out, HasSubstr("24 triangles"));
    EXPECT_THAT(result.out, HasSubstr("non-manifold edge: 1 -> 0"));
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(findings_of(report, "repeated triangle"), 1);
    EXPECT_EQ(findings_of(report, "triangle with the wrong winding"), 12);
    EXPECT_EQ(findings_of(report, "non-manifold edge"), 1);
    EXPECT_EQ(report["options"]["two_sided"], "keep");
    EXPECT_EQ(workplace.run("relief-mesh check out/cubes.obj --strict").exit_code, 0);
    // A second repair has no findings.
    ASSERT_EQ(
        workplace.run("relief-mesh repair out/cubes.obj out/again.obj --quiet --strict").exit_code,
        0);
    // Each step can be left out.
    ASSERT_EQ(workplace
                  .run("relief-mesh repair cubes.obj out/same.obj --no-weld --keep-duplicates "
                       "--no-orient --no-separate --report out/same.json")
                  .exit_code,
              0);
    EXPECT_TRUE(json::parse(workplace.read("out/same.json"))["findings"].empty());
}

TEST(RepairCommand, MeasuresLengthsInUnitsAndShares) {
    const Workplace workplace;
    workplace.write("gap.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.001 0 0\nv 1 1 0\nv 0 1.001 0\n"
                    "v 5 5 5\nv 5.01 5 5\nv 5 5.01 5\nf 1 2 3\nf 4 5 6\nf 7 8 9\n");
    const auto boundaries = [&](const std::string& options) {
        EXPECT_EQ(
            workplace.run("relief-mesh repair gap.obj out/a.obj --report out/a.json " + options)
                .exit_code,
            0);
        return count_after(json::parse(workplace.read("out/a.json")), "boundary edge");
    };
    EXPECT_EQ(boundaries(""), 9U);
    EXPECT_EQ(boundaries("--weld 0.002"), 7U);
    EXPECT_EQ(boundaries("--weld 0.05%"), 7U);
    EXPECT_EQ(boundaries("--weld 0.001%"), 9U);
    EXPECT_EQ(boundaries("--drop-below 0.05"), 6U);
}

TEST(RemeshCommand, WritesAWatertightModelAndItsDistances) {
    const Workplace workplace;
    workplace.write("cubes.obj", touching_cubes);
    const ProgramResult result = workplace.run(
        "relief-mesh remesh cubes.obj out/solid.ply --resolution 24 --report out/report.json");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("of IN from OUT"));
    const json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(count_after(report, "boundary edge"), 0U);
    EXPECT_EQ(count_after(report, "non-manifold edge"), 0U);
    EXPECT_LT(report["distance"]["of_output"]["max"], 2.0 / 24.0);
    EXPECT_EQ(count_after(report, "bow-tie vertex"), 0U);
}

TEST(RemeshCommand, MakesShellsOfOpenSurfacesOnRequest) {
    const Workplace workplace;
    workplace.write_square("square.obj", true);
    EXPECT_EQ(workplace
                  .run("relief-mesh remesh square.obj out/square.glb --resolution 16 --shell "
                       "--quiet")
                  .exit_code,
              0);
}

TEST(RemeshCommand, RemovesTangentsWithoutTextureCoordinates) {
    const Workplace workplace;
    ASSERT_EQ(workplace.run("relief-mesh process data/vase.obj out/a.glb --tangents mikktspace")
                  .exit_code,
              0);
    const ProgramResult result =
        workplace.run("relief-mesh remesh out/a.glb out/b.glb --resolution 24");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("tangents of other triangles"));
}

TEST(RepairAndRemeshCommands, RefuseWrongOptions) {
    const Workplace workplace;
    workplace.write_square("square.obj", true);
    expect_refusals(
        workplace, "relief-mesh", "old.obj",
        {{"relief-mesh repair square.obj out/old.obj --weld 1% --no-weld", 2,
          "--weld and --no-weld contradict each other (give one of them)"},
         {"relief-mesh repair square.obj out/old.obj --weld -1", 2, "--weld -1: "},
         {"relief-mesh repair square.obj out/old.obj --weld 101%", 2,
          "--weld 101%: not between 0 and 100 %"},
         {"relief-mesh repair square.obj out/old.obj --drop-below 2", 2,
          "--drop-below 2: not between 0 and 1"},
         {"relief-mesh remesh square.obj out/old.obj --resolution 5", 2,
          "--resolution 5: not between 8 and 1024"},
         {"relief-mesh remesh square.obj out/old.obj --resolution 16", 1,
          "square.obj: the triangles enclose nothing that is as thick as a cell at resolution "
          "16"}});
}

}  // namespace
}  // namespace relief::tools
