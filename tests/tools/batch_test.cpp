// SPDX-License-Identifier: Apache-2.0
// Jobs on many files: order, failures and reports. process_batch_test.cpp tests the command line.
#include "common/file_jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <fstream>
#include <thread>

#include "support/shared_data.h"

namespace relief::tools {
namespace {

using nlohmann::json;
using test::TemporaryDirectory;

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

TEST(Batch, SaysWhatBecameOfFilesInTheirOrderWhoeverIsDoneFirst) {
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

}  // namespace
}  // namespace relief::tools
