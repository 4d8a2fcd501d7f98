// SPDX-License-Identifier: Apache-2.0
#include "window/file_watch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "support/shared_data.h"
#include "tools/window/display.h"

namespace relief::tools {
namespace {

using test::eventually;
using Purpose = FileWatch::Purpose;

bool has(const FileWatch::Changes& changes, Purpose purpose) {
    return changes[static_cast<std::size_t>(purpose)];
}

class Watching : public testing::Test {
  protected:
    [[nodiscard]] std::filesystem::path path(const std::string& name) const {
        return folder_ / name;
    }
    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::ofstream(path(name)) << text;
        return path(name);
    }
    FileWatch::Files stamped(const std::vector<std::string>& names) {
        FileWatch::Files files;
        for (const std::string& name : names)
            files[path(name)] = stamp_of(path(name));
        return files;
    }
    FileWatch& watch() { return watch_; }
    /// Whether changes for that purpose, and no other, are told by and by.
    bool tells(Purpose purpose) {
        FileWatch::Changes changes{};
        const auto is_told = [&] {
            changes = watch_.take();
            return changes != FileWatch::Changes{};
        };
        const bool is_any = eventually(is_told);
        changes[static_cast<std::size_t>(purpose)] ^= true;
        return is_any && changes == FileWatch::Changes{};
    }
    /// After several looks.
    bool tells_nothing() {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        return watch_.take() == FileWatch::Changes{};
    }
    [[nodiscard]] int woken() const { return woken_; }

  private:
    test::TemporaryDirectory folder_;
    std::atomic<int> woken_ = 0;
    FileWatch watch_{[this] { ++woken_; }, std::chrono::milliseconds(10)};
};

TEST_F(Watching, TellsOnceThatAFileHasChangedAndWakes) {
    write("a", "1");
    write("b", "1");
    watch().watch(Purpose::scene, stamped({"a"}));
    watch().watch(Purpose::picture, stamped({"b"}));
    EXPECT_EQ(watch().count(), 2U);
    EXPECT_TRUE(tells_nothing());
    EXPECT_EQ(woken(), 0);
    write("b", "22");
    EXPECT_TRUE(tells(Purpose::picture));
    EXPECT_EQ(woken(), 1);
    EXPECT_TRUE(tells_nothing());
    write("b", "333");
    EXPECT_TRUE(tells(Purpose::picture)) << "from how it was told";
}

TEST_F(Watching, AFileThatWasReplacedRemovedOrComesHasChanged) {
    write("a", "1");
    watch().watch(Purpose::scene, stamped({"a", "missing"}));
    write("beside", "1");
    std::filesystem::last_write_time(path("beside"), std::filesystem::last_write_time(path("a")));
    std::filesystem::rename(path("beside"), path("a"));  // Same size, same time.
    EXPECT_TRUE(tells(Purpose::scene));
    write("missing", "");
    EXPECT_TRUE(tells(Purpose::scene));
    std::filesystem::remove(path("a"));
    EXPECT_TRUE(tells(Purpose::scene));
    EXPECT_TRUE(tells_nothing());
}

TEST_F(Watching, AChangeSinceTheStampIsOne) {
    write("a", "1");
    const FileWatch::Files files = stamped({"a"});
    write("a", "22");
    watch().watch(Purpose::attempt, files);
    EXPECT_TRUE(tells(Purpose::attempt));
}

TEST_F(Watching, WhatIsWrittenByAndByIsToldWhenItRests) {
    using Clock = std::chrono::steady_clock;
    const std::chrono::milliseconds period(100);
    write("a", "");
    write("b", "1");
    FileWatch watch([] {}, period);
    watch.watch(Purpose::scene, stamped({"a", "b"}));
    std::ofstream slow(path("a"));
    bool is_told = false;
    Clock::duration longest_pause{0};
    const Clock::time_point begin = Clock::now();
    for (Clock::time_point last = begin; last - begin < 5 * period;) {
        slow << "more" << std::flush;
        is_told |= watch.take() != FileWatch::Changes{};
        longest_pause = std::max(longest_pause, Clock::now() - last);
        last = Clock::now();
    }
    // Whoever pauses as long as a look takes to come again has rested.
    EXPECT_FALSE(is_told && longest_pause < period / 2);
    slow << "the end" << std::flush;
    EXPECT_TRUE(eventually([&] { return has(watch.take(), Purpose::scene); }));
}

TEST_F(Watching, WhatIsWatchedNoMoreIsNotTold) {
    write("a", "1");
    watch().watch(Purpose::scene, stamped({"a"}));
    watch().watch(Purpose::scene, {});
    write("a", "22");
    EXPECT_TRUE(tells_nothing());
    EXPECT_EQ(watch().count(), 0U);
}

}  // namespace
}  // namespace relief::tools
