// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/file_watch_test.cpp.
#include "window/file_watch.h"

#include <algorithm>
#include <utility>

namespace relief::tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int look_share = 200;  // A look takes at most one part in so many of the time.

/// Which of them are not as they were.
std::vector<std::filesystem::path> changed_files(const FileWatch::Files& files,
                                                 const FileWatch::Files& now) {
    std::vector<std::filesystem::path> changed;
    for (const auto& [path, stamp] : files) {
        const auto found = now.find(path);
        if (found != now.end() && found->second != stamp) changed.push_back(path);
    }
    return changed;
}

}  // namespace

FileWatch::FileWatch(std::function<void()> wake, std::chrono::milliseconds period)
    : wake_(std::move(wake)), period_(period), thread_([this] { run(); }) {}

FileWatch::~FileWatch() {
    {
        const std::lock_guard lock(mutex_);
        is_ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void FileWatch::watch(Purpose purpose, Files files) {
    {
        const std::lock_guard lock(mutex_);
        const auto place = static_cast<std::size_t>(purpose);
        watched_[place] = std::move(files);
        changes_[place] = false;
    }
    changed_.notify_all();
}

FileWatch::Changes FileWatch::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(changes_, {});
}

std::size_t FileWatch::count() const {
    const std::lock_guard lock(mutex_);
    Files all;
    for (const Files& files : watched_)
        all.insert(files.begin(), files.end());
    return all.size();
}

void FileWatch::run() {
    std::unique_lock lock(mutex_);
    while (!is_ending_) {
        const auto has_files = [&] {
            return std::any_of(watched_.begin(), watched_.end(),
                               [](const Files& files) { return !files.empty(); });
        };
        changed_.wait(lock, [&] { return is_ending_ || has_files(); });
        lock.unlock();
        const Clock::time_point begin = Clock::now();
        look();
        const Clock::duration pause =
            std::max<Clock::duration>(period_, look_share * (Clock::now() - begin));
        lock.lock();
        changed_.wait_for(lock, pause, [&] { return is_ending_; });
    }
}

/// Files are looked at without the lock: a network may take its time.
void FileWatch::look() {
    Files now;
    {
        const std::lock_guard lock(mutex_);
        for (const Files& files : watched_)
            now.insert(files.begin(), files.end());
    }
    for (auto& [path, stamp] : now)
        stamp = stamp_of(path);
    const auto rests = [&](const std::filesystem::path& path) {
        const auto before = seen_.find(path);
        return before != seen_.end() && before->second == now.at(path);
    };
    bool has_changes = false;
    {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < purposes; ++i) {
            const std::vector<std::filesystem::path> changed = changed_files(watched_[i], now);
            if (changed.empty() || !std::all_of(changed.begin(), changed.end(), rests)) continue;
            for (const std::filesystem::path& path : changed)
                watched_[i][path] = now.at(path);
            changes_[i] = has_changes = true;
        }
    }
    seen_ = std::move(now);
    if (has_changes) wake_();
}

}  // namespace relief::tools
