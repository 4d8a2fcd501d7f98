// SPDX-License-Identifier: Apache-2.0
#include "window/newest_job.h"

#include <gtest/gtest.h>

#include <atomic>

#include "progress_stage.h"
#include "support/shared_data.h"
#include "tools/window/display.h"

namespace relief::tools {
namespace {

using test::eventually;

/// Goes on until somebody ends it.
int go_on(const Progress& progress, std::atomic<int>& ended) {
    while (!progress.is_cancelled())
        test::pause_a_little();
    ++ended;
    throw Cancelled();
}

TEST(NewestJob, GivesItsResultOnceAndWakes) {
    std::atomic<int> woken = 0;
    NewestJob<int> job([&] { ++woken; });
    EXPECT_FALSE(job.is_going_on());
    job.start([](const Progress&) { return 7; });
    ASSERT_TRUE(eventually([&] { return woken == 1; }));
    EXPECT_TRUE(job.is_going_on()) << "until it is taken";
    EXPECT_EQ(job.take(), 7);
    EXPECT_FALSE(job.is_going_on());
    EXPECT_FALSE(job.take());
}

TEST(NewestJob, ABeginningEndsWhatWasBegunBefore) {
    std::atomic<int> ended = 0, woken = 0;
    NewestJob<int> job([&] { ++woken; });
    for (int i = 0; i < 3; ++i)
        job.start([&](const Progress& progress) { return go_on(progress, ended); });
    job.start([](const Progress&) { return 4; });
    ASSERT_TRUE(eventually([&] { return ended == 3 && woken == 1; }));
    EXPECT_EQ(job.take(), 4);
}

TEST(NewestJob, CancellingEndsTheWorkAndTheObjectEndsAtOnce) {
    std::atomic<int> ended = 0, woken = 0;
    {
        NewestJob<int> job([&] { ++woken; });
        job.start([&](const Progress& progress) { return go_on(progress, ended); });
        job.cancel();
        EXPECT_FALSE(job.is_going_on());
        EXPECT_TRUE(eventually([&] { return ended == 1; }));
        job.start([&](const Progress& progress) { return go_on(progress, ended); });
    }
    EXPECT_EQ(ended, 2);
    EXPECT_EQ(woken, 0);
}

TEST(NewestJob, ItsWorkReportsToItsProgress) {
    const test::TemporaryDirectory folder;
    std::atomic<bool> may_end = false;
    NewestJob<std::size_t> job([] {});
    job.start([&](const Progress& progress) {
        note_file(folder / "looked for");
        const ProgressStage stage("looking", 4);
        while (!may_end)
            test::pause_a_little();
        return progress.files().size();
    });
    EXPECT_TRUE(eventually([&] { return job.progress().stage == "looking"; }));
    EXPECT_EQ(job.progress().part, 0.0);
    may_end = true;
    std::optional<std::size_t> files;
    ASSERT_TRUE(eventually([&] { return (files = job.take()).has_value(); }));
    EXPECT_EQ(files, 1U);
    EXPECT_EQ(job.progress().stage, "");
}

}  // namespace
}  // namespace relief::tools
