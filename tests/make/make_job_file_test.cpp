// SPDX-License-Identifier: Apache-2.0
// The file of `relief make --job`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

TEST(JobFile, MakesAssetsWithTheirOptionsAndSkipsUnchangedOnes) {
    const Workplace workplace;
    std::filesystem::create_directory(workplace / "jobs");
    workplace.write("jobs/assets.json", R"({
  "output": "../out/assets/",
  "defaults": {"size": 32, "padding": 1, "occlusion-rays": 0, "triangles": 300,
               "remesh": "never"},
  "assets": [
    {"input": "../data/vase.obj"},
    {"input": "../data/vase.obj", "output": "small/vase.glb", "triangles": 200, "crease": "none",
     "size": "64x32"}
  ]
})");
    const std::string line =
        "relief make --job jobs/assets.json --report out/report.json --threads 1";
    ProgramResult result = workplace.run(line);
    ASSERT_EQ(result.exit_code, 0) << result.error;
    json report = json::parse(workplace.read("out/report.json"));
    EXPECT_EQ(report["job"], "jobs/assets.json");
    ASSERT_EQ(report["files"].size(), 2U);
    EXPECT_EQ(report["files"][0]["triangles"], 300);
    EXPECT_EQ(report["files"][1]["triangles"], 200);
    EXPECT_EQ(report["files"][1]["options"]["size"], json({64, 32}));
    EXPECT_TRUE(report["files"][1]["options"]["crease"].is_null());
    // The same as by the command.
    ASSERT_EQ(workplace
                  .run("relief make data/vase.obj out/vase.glb --triangles 200 --size 64x32 "
                       "--padding 1 --occlusion-rays 0 --crease none --remesh never")
                  .exit_code,
              0);
    EXPECT_TRUE(workplace.read("out/vase.glb") == workplace.read("out/assets/small/vase.glb"));
    result = workplace.run(line);
    EXPECT_THAT(result.out, HasSubstr("out/assets/vase.glb: unchanged"));
    EXPECT_THAT(result.out, HasSubstr("out/assets/small/vase.glb: unchanged"));
    // Only the asset whose options change is made again.
    json job = json::parse(workplace.read("jobs/assets.json"));
    job["assets"][1]["triangles"] = 150;
    workplace.write("jobs/assets.json", job.dump(2));
    result = workplace.run("relief make --job jobs/assets.json --report out/index.html");
    EXPECT_THAT(result.out, HasSubstr("out/assets/vase.glb: unchanged"));
    EXPECT_THAT(result.out, HasSubstr("150 triangles"));
    EXPECT_THAT(workplace.read("out/index.html"), HasSubstr("assets.json"));
}

TEST(JobFile, IsRefusedWithTheLineAndTheKeyBeforeAnythingIsMade) {
    const Workplace workplace;
    const auto expect_fault = [&](const std::string& text, const std::string& words) {
        workplace.write("job.json", text);
        const ProgramResult result = workplace.run("relief make --job job.json");
        EXPECT_EQ(result.exit_code, 1) << text;
        EXPECT_THAT(result.error, HasSubstr("job.json: " + words)) << text;
        EXPECT_EQ(workplace.outputs(), "") << text;
    };
    const std::string good = R"({"input": "data/vase.obj", "output": "out/a.glb"})";
    expect_fault("{\"assets\": [" + good + ",\n{\"input\": \"data/vase.obj\",\n\"trianlges\": 5}]}",
                 "line 3: assets[1].trianlges: unknown key (not one of input, output, with, up, "
                 "source-crease, "
                 "triangles,");
    expect_fault("{\"defaults\":\n{\"report\": 5},\"assets\": [" + good + "]}",
                 "line 2: defaults.report: unknown key");
    expect_fault("{\"assets\": [" + good + "], \"version\": 1}", "line 1: version: unknown key");
    expect_fault("{\"assets\": [{\"input\": \"data/vase.obj\",\n\n\"size\": 8}]}",
                 "line 3: assets[0].size: --size 8: ");
    expect_fault("{\"assets\": [{\"input\": \"data/vase.obj\", \"loss\": 1}]}",
                 "line 1: assets[0].loss: is neither true nor false");
    expect_fault("{\"assets\": [{\"input\": \"data/vase.obj\", \"size\": true}]}",
                 "line 1: assets[0].size: is neither text nor a number");
    expect_fault("{\"assets\": [{\"input\": \"data/vase.obj\",\n\"size\": 32, \"size\": 64}]}",
                 "line 2: assets[0].size: the key is repeated");
    expect_fault("{\"assets\": [\n{\"triangles\": 5}]}", "line 2: assets[0]: has no \"input\"");
    expect_fault("{\"assets\": [{\"input\": 7}]}", "line 1: assets[0].input: is not the name");
    expect_fault("{\"assets\": [" + good + ", 3]}", "line 1: assets[1]: is not an object");
    expect_fault("{\"assets\": []}", "line 1: assets: is empty");
    expect_fault("{\"assets\": {}}", "line 1: assets: is not a list");
    expect_fault("{}", "has no \"assets\"");
    expect_fault("[]", "is not a JSON object");
    expect_fault("{\"assets\": [", "[json.exception");
    expect_fault(
        "{\"assets\": [{\"input\": \"data/vase.obj\", \"remesh\": \"never\", "
        "\"resolution\": 64}]}",
        "line 1: assets[0]: --resolution: has no effect");
    expect_fault("{\"assets\": [{\"input\": \"data/vase.obj\", \"view\": \"30,20\"}]}",
                 "line 1: assets[0]: --view: has no effect");
    const ProgramResult options = workplace.run("relief make --job job.json --triangles 5");
    EXPECT_EQ(options.exit_code, 2);
    EXPECT_THAT(options.error,
                HasSubstr("--triangles: options of assets are in the file of --job"));
    const ProgramResult files = workplace.run("relief make data/vase.obj --job job.json");
    EXPECT_EQ(files.exit_code, 2);
    EXPECT_THAT(files.error, HasSubstr("--job job.json: names its models and outputs itself"));
}

}  // namespace
}  // namespace relief::tools
