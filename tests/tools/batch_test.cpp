// SPDX-License-Identifier: Apache-2.0
// Jobs on many files: order, failures and reports; the names of outputs of `relief-mesh process`.
#include "common/model_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/file_jobs.h"
#include "support/invariants.h"
#include "support/labels.h"
#include "support/shared_data.h"
#include "tools/file_jobs_words.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::jobs_text;
using test::message_of;
using test::ProgramResult;
using test::TemporaryDirectory;
using test::Workplace;
using testing::HasSubstr;
using testing::MatchesRegex;

/// Returns six jobs. The fourth fails, and the first takes longest.
Batch six_files() {
    Batch batch;
    for (const char* name : {"a", "b", "c", "d", "e", "f"})
        batch.jobs.push_back({name, std::string("out/") + name});
    batch.head = {{"tool", "test"}};
    batch.work = [](std::size_t index) {
        if (index == 0) std::this_thread::sleep_for(std::chrono::milliseconds(30));
        if (index == 3) throw InvalidInput("no good");
        FileOutcome outcome{"line " + std::to_string(index), {}, {}};
        outcome.summary.add_json({{"index", index}});
        return outcome;
    };
    return batch;
}

TEST(Batch, ReportsFilesInOrder) {
    const CLI::App app("", "relief-test");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const ExitCode code = run_batch(app, six_files(), {}, {});
    EXPECT_EQ(code, ExitCode::failed);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "relief-test: error: d: no good\n");
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "line 0\nline 1\nline 2\nline 4\nline 5\nin all    6 files, 1 failed\n");
}

TEST(Batch, ReportsEveryFile) {
    const TemporaryDirectory folder;
    const CLI::App app("", "relief-test");
    testing::internal::CaptureStderr();
    run_batch(app, six_files(), {.file = folder / "r.json", .strict = false}, {.quiet = true});
    testing::internal::GetCapturedStderr();
    std::ifstream file(folder / "r.json");
    const json report = json::parse(file);
    EXPECT_EQ(report["tool"], "test");
    EXPECT_EQ(report["failed"], 1);
    ASSERT_EQ(report["files"].size(), 6U);
    EXPECT_EQ(report["files"][2], json({{"input", "c"}, {"output", "out/c"}, {"index", 2}}));
    EXPECT_EQ(report["files"][3],
              json({{"input", "d"}, {"output", "out/d"}, {"error", "d: no good"}}));
}

TEST(Batch, OneByOneNeverDoesTwoAtATime) {
    Batch batch;
    batch.jobs.resize(40, {"a", "b"});
    batch.one_by_one = true;
    std::atomic<int> running = 0;
    std::atomic<int> most = 0;
    std::vector<std::size_t> order;
    batch.work = [&](std::size_t index) {
        most = std::max(most.load(), ++running);
        order.push_back(index);
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        --running;
        return FileOutcome{};
    };
    const CLI::App app("", "relief-test");
    EXPECT_EQ(run_batch(app, batch, {}, {.quiet = true}), ExitCode::done);
    EXPECT_EQ(most, 1);
    EXPECT_EQ(order.size(), 40U);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

std::string model_refusal(const FileWords& words, std::optional<ModelFormat> format = {}) {
    return message_of<UsageError>([&] { model_jobs_of(words, format); });
}

TEST(ProcessJobs, InAFolderModelsKeepNamesAndWritableFormats) {
    EXPECT_EQ(
        jobs_text(model_jobs_of({{"x/a.obj", "b.PLY", "c.stl", "d.off", "e.v2.gltf"}, "out/"}, {})),
        "x/a.obj -> out/a.obj, b.PLY -> out/b.PLY, c.stl -> out/c.glb, d.off -> out/d.glb, "
        "e.v2.gltf -> out/e.v2.gltf");
    EXPECT_EQ(jobs_text(model_jobs_of({{"x/a.obj", "e.v2.gltf"}, "out/"}, ModelFormat::ply)),
              "x/a.obj -> out/a.ply, e.v2.gltf -> out/e.v2.ply");
}

TEST(ProcessJobs, TwoModelsThatGetOneNameByTheirFormatAreRefused) {
    const TemporaryDirectory folder;
    const std::string here = folder.path().string() + "/";
    EXPECT_EQ(model_refusal({{here + "a.glb", here + "a.obj"}, here}, ModelFormat::obj),
              here + "a.glb and " + here + "a.obj: have the same output " + here + "a.obj");
}

TEST(ProcessJobs, RefusesFormatsThatDoNotServe) {
    EXPECT_EQ(model_refusal({{"a.obj", "b.obj", "c.obj"}, "d.glb"}),
              "-o d.glb: is a file, but there are 3 models");
    EXPECT_EQ(model_refusal({{"a.obj", "b.glb"}, {}}, ModelFormat::obj),
              "--format obj: the name b.glb already has a format");
    EXPECT_EQ(model_refusal({{"a.txt"}, "out/"}), "a.txt: .txt is not a format that can be read");
    const TemporaryDirectory folder;
    EXPECT_EQ(model_refusal({{folder.path()}, "out/"}), folder.path().string() + ": is a folder");
}

TEST(ProcessBatch, AModelWithoutTextureCoordinatesIsAFindingUnlessTangentsAreRequired) {
    const Workplace workplace;
    workplace.write_square("a.obj");
    workplace.write_square("plain.obj", true);
    const std::string line =
        "relief-mesh process a.obj plain.obj -o out/ --format glb --tangents mikktspace ";
    const ProgramResult result = workplace.run(line + "--report out/r.json");
    EXPECT_EQ(result.exit_code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr("out/plain.glb: 2 triangles, 4 vertices, normals computed, "
                                      "averaged by angle, tangents none, 1 finding, "));
    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_TRUE(report["files"][0]["findings"].empty());
    EXPECT_EQ(report["files"][1]["findings"][0]["kind"], "model without texture coordinates");
    EXPECT_EQ(report["files"][1]["findings"][0]["outcome"], "gets no tangents");
    EXPECT_EQ(workplace.run(line + "--strict --quiet").exit_code, 3);
    // A glTF model is judged by its primitives, and the outcome is the same.
    ASSERT_EQ(workplace.run("relief-mesh process plain.obj out/plain.gltf").exit_code, 0);
    const ProgramResult document = workplace.run(
        "relief-mesh process a.obj out/plain.gltf -o out/glb/ --format glb --tangents mikktspace");
    EXPECT_EQ(document.exit_code, 0) << document.error;
    EXPECT_THAT(document.out, HasSubstr("tangents none, 1 finding, "));
    const ProgramResult required = workplace.run(line + "--require-tangents");
    EXPECT_EQ(required.exit_code, 1);
    EXPECT_THAT(required.error, HasSubstr("plain.obj: no texture coordinates, so there can be no "
                                          "tangents"));
    const ProgramResult useless =
        workplace.run("relief-mesh process a.obj out/a.glb --require-tangents");
    EXPECT_EQ(useless.exit_code, 2);
}

TEST(ProcessBatch, WritesEveryModelUnderItsNameInAFolderThatItMakes) {
    const Workplace workplace;
    workplace.write_square("a.obj");
    workplace.write_square("b.obj");
    const ProgramResult result =
        workplace.run("relief-mesh process a.obj b.obj -o out/new/models/ --format glb");
    ASSERT_EQ(result.exit_code, 0) << result.error;
    EXPECT_EQ(result.error, "") << "progress is for terminals";
    EXPECT_THAT(result.out,
                MatchesRegex("out/new/models/a.glb: 2 triangles, 4 vertices, normals computed, "
                             "averaged by angle, tangents none, no findings, [^\n]*\n"
                             "out/new/models/b.glb: 2 triangles, [^\n]*\n"
                             "in all    2 files\n"));
    // Separate calls write the same bytes.
    ASSERT_EQ(workplace.run("relief-mesh process b.obj out/alone.glb").exit_code, 0);
    EXPECT_EQ(workplace.read("out/new/models/b.glb"), workplace.read("out/alone.glb"));
}

TEST(ProcessBatch, OneThatFailsDoesNotStopTheOthers) {
    const Workplace workplace;
    workplace.write_square("a.obj");
    workplace.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    workplace.write_square("c.obj");
    workplace.write("out/bad.obj", "old");
    const ProgramResult result = workplace.run(
        "relief-mesh process a.obj bad.obj missing.ply c.obj -o out/ --report out/r.json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, MatchesRegex("relief-mesh: error: bad.obj: [^\n]*\n"
                                           "relief-mesh: error: missing.ply: [^\n]*\n"));
    EXPECT_THAT(result.out, HasSubstr("in all    4 files, 2 failed\n"));
    EXPECT_EQ(workplace.outputs(), "a.obj bad.obj c.obj r.json");
    EXPECT_EQ(workplace.read("out/bad.obj"), "old");

    const json report = json::parse(workplace.read("out/r.json"));
    EXPECT_EQ(report["tool"], "relief-mesh process");
    EXPECT_EQ(report["failed"], 2);
    EXPECT_EQ(report["options"]["normals"], "keep");
    ASSERT_EQ(report["files"].size(), 4U);
    EXPECT_EQ(report["files"][0]["input"], "a.obj");
    EXPECT_EQ(report["files"][0]["output"], "out/a.obj");
    EXPECT_EQ(report["files"][0]["primitives"][0]["triangles"], 2);
    EXPECT_FALSE(report["files"][0].contains("error"));
    EXPECT_THAT(report["files"][1]["error"].get<std::string>(), HasSubstr("bad.obj: "));
    EXPECT_FALSE(report["files"][1].contains("primitives"));
    EXPECT_EQ(report["files"][3]["findings"], json::array());
}

TEST(ProcessBatch, StrictNamesEveryModelWithFindings) {
    const Workplace workplace;
    const std::string bad = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n";
    workplace.write("a.obj", bad);
    workplace.write_square("b.obj");
    workplace.write("c.obj", bad);
    const ProgramResult result = workplace.run(
        "relief-mesh process a.obj b.obj c.obj -o out/ --normals area --strict --quiet");
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.error,
                MatchesRegex("relief-mesh: warning: a.obj: [0-9]+ findings? [^\n]*\n"
                             "relief-mesh: warning: c.obj: [0-9]+ findings? [^\n]*\n"));
    EXPECT_EQ(workplace.outputs(), "a.obj b.obj c.obj");
    // A failure takes precedence over a finding.
    EXPECT_EQ(workplace.run("relief-mesh process a.obj gone.obj -o out/ --normals area --strict")
                  .exit_code,
              1);
}

TEST(ProcessBatch, RefusesBeforeAnythingIsDone) {
    const Workplace workplace;
    workplace.write_square("a.obj");
    workplace.write_square("deep/a.obj");
    for (const char* line : {"relief-mesh process a.obj deep/a.obj -o out/new/",
                             "relief-mesh process a.obj a.txt -o out/new/",
                             "relief-mesh process a.obj deep -o out/new/",
                             "relief-mesh process a.obj -o out/new/ --tangents mikktspace",
                             "relief-mesh process a.obj -o out/new/ --format stl"}) {
        const ProgramResult result = workplace.run(line);
        EXPECT_EQ(result.exit_code, 2) << line << "\n" << result.error;
        EXPECT_EQ(workplace.outputs(), "") << line;
    }
}

TEST(ProcessBatch, RefusesAFileAsFolder) {
    const Workplace workplace;
    workplace.write_square("a.obj");
    workplace.write("out/taken", "old");
    const ProgramResult result = workplace.run("relief-mesh process a.obj -o out/taken/");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.error, "relief-mesh: error: out/taken/: exists, but is not a folder\n");
    EXPECT_EQ(workplace.read("out/taken"), "old");
}

TEST_LABELS(not_sanitized);
TEST(ProcessBatch, RealModelsComeOutTheSameForAnyNumberOfThreads) {
    RELIEF_NEEDS_SHARED(models, "data/models/gltf");
    constexpr std::array models_named = {"WaterBottle", "Corset", "BoomBox"};
    const Workplace workplace;
    std::string inputs;
    for (const char* model : models_named)
        inputs += (models / model / "glTF" / model).string() + ".gltf ";
    for (const char* threads : {"1", "3"}) {
        const ProgramResult result =
            workplace.run("relief-mesh process " + inputs + "-o out/" + threads +
                          "/ --format glb --normals angle --threads " + threads);
        ASSERT_EQ(result.exit_code, 0) << result.error;
    }
    for (const char* model : models_named) {
        const std::string name = std::string(model) + ".glb";
        EXPECT_EQ(workplace.read("out/1/" + name), workplace.read("out/3/" + name)) << name;
        EXPECT_GT(workplace.read("out/1/" + name).size(), 1000U);
    }
}

}  // namespace
}  // namespace relief::tools
