// SPDX-License-Identifier: Apache-2.0
// Progress reports, cancellation, and the list of files that were read.
#include "relief/mesh/execution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>
#include <vector>

#include "files.h"
#include "parallel.h"
#include "progress_stage.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::detail;

namespace {

TEST(Progress, WithoutAScopeNothingIsCountedOrStopped) {
    Progress progress;
    progress.cancel();
    ProgressStage stage("parsing", 10);
    EXPECT_NO_THROW(stage.advance(5));
    EXPECT_NO_THROW(check_cancelled());
    EXPECT_EQ(progress.state().stage, "");
}

TEST(Progress, InnerStageReplacesTheOuterOneTemporarily) {
    Progress progress;
    const ProgressScope scope(progress);
    ProgressStage outer("meshes", 4);
    outer.advance(1);
    {
        ProgressStage inner("normals");
        inner.advance(7);
        EXPECT_EQ(progress.state().stage, "normals");
        EXPECT_EQ(progress.state().part, std::nullopt);
    }
    EXPECT_EQ(progress.state().stage, "meshes");
    EXPECT_EQ(progress.state().part, 0.25);
    outer.advance(2);
    EXPECT_EQ(progress.state().part, 0.75);
    outer.advance(9);
    EXPECT_EQ(progress.state().part, 1.0) << "never beyond the whole";
}

TEST(Progress, ReportsEachPercentOnce) {
    std::vector<int> told;
    Progress progress([&](const Progress::State& state) {
        if (state.part) told.push_back(static_cast<int>(100 * *state.part + 0.5));
    });
    const ProgressScope scope(progress);
    ProgressStage stage("reading", 1000);
    for (int i = 0; i < 100; ++i)
        stage.advance(1);
    EXPECT_THAT(told, testing::ElementsAre(0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
}

TEST(Progress, LoopsThatAreSharedOutCountAndStop) {
    constexpr std::size_t count = 1 << 20;
    Progress progress;
    const ProgressScope scope(progress);
    std::vector<int> visits(count, 0);
    {
        ProgressStage stage("loop", count);
        parallel_for(count, 100, [&](std::size_t begin, std::size_t end) {
            EXPECT_EQ(current_progress, &progress) << "in each thread";
            for (std::size_t i = begin; i < end; ++i)
                ++visits[i];
            stage.advance(end - begin);
        });
        EXPECT_EQ(progress.state().part, 1.0);
    }
    EXPECT_THAT(visits, testing::Each(1));

    std::atomic<std::size_t> visited = 0;
    EXPECT_THROW(parallel_for(count, 100,
                              [&](std::size_t begin, std::size_t end) {
                                  visited += end - begin;
                                  progress.cancel();
                              }),
                 Cancelled);
    // Each running thread finishes at most one piece of a 256th.
    EXPECT_LE(visited, thread_count() * (count / 256 + 100));
    EXPECT_THROW(parallel_for(1, 100, [](std::size_t, std::size_t) { FAIL(); }), Cancelled)
        << "a wish stays";
}

TEST(Progress, StagesWithinPiecesAreSilent) {
    Progress progress;
    const ProgressScope scope(progress);
    ProgressStage stage("images", 2);
    parallel_for(2, 1, [&](std::size_t, std::size_t) {
        ProgressStage inner("reading", 10);
        inner.advance(3);
        EXPECT_EQ(progress.state().stage, "images");
    });
    EXPECT_EQ(progress.state().part, 0.0);
}

TEST(Progress, EveryThreadHasItsOwn) {
    Progress one, other;
    const ProgressScope scope(one);
    std::thread([&] {
        EXPECT_EQ(current_progress, nullptr);
        const ProgressScope own(other);
        other.cancel();
        EXPECT_THROW(check_cancelled(), Cancelled);
    }).join();
    EXPECT_NO_THROW(check_cancelled());
}

TEST(Progress, FilesThatWereReadOrMissedAreKnown) {
    const test::TemporaryDirectory folder;
    const std::filesystem::path there = folder / "there.txt";
    std::ofstream(there) << "four";
    Progress progress;
    {
        const ProgressScope scope(progress);
        EXPECT_EQ(read_file(there), "four");
        EXPECT_EQ(FileContents(folder / "." / "there.txt").text(), "four");
        EXPECT_THROW(read_file(folder / "missing.txt"), FileError);
    }
    read_file(there);  // No progress object exists.
    const auto files = progress.files();
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files.at(there).size, 4U);
    EXPECT_EQ(files.at(folder / "missing.txt"), FileStamp());
    EXPECT_EQ(files.at(there), stamp_of(there));
    std::ofstream(there) << "longer";
    EXPECT_NE(files.at(there), stamp_of(there));
}

}  // namespace
}  // namespace relief
