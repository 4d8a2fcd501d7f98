// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files looked at every half second by a thread of their own, until some of them change and rest:
/// what is written by and by is told once it is whole, and one that is replaced by renaming, or
/// that comes or goes, has changed too. Only looked at, never opened.
/// Tests: tests/tools/window/file_watch_test.cpp.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "relief/mesh/progress.h"

namespace relief::tools {

class FileWatch {
  public:
    /// What files are watched for; each is told by itself.
    enum class Purpose { scene, attempt, picture, shaders };
    static constexpr std::size_t purposes = 4;

    using Files = std::map<std::filesystem::path, FileStamp>;
    using Changes = std::array<bool, purposes>;  ///< By purpose.

    /// \param wake    called, from another thread, when there is something to take
    /// \param period  between two looks; it is longer where a look takes more than a two hundredth
    ///                of it, so that watching costs next to nothing
    explicit FileWatch(std::function<void()> wake,
                       std::chrono::milliseconds period = std::chrono::milliseconds(500));
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;

    /// These take the place of what was watched for that purpose. A file that is not as its stamp
    /// says has changed already.
    void watch(Purpose purpose, Files files);

    /// For which purposes files have changed and rest, since the last call. Until they are watched
    /// anew, they change again only from how they are now.
    Changes take();

    [[nodiscard]] std::size_t count() const;

  private:
    void run();
    void look();

    std::function<void()> wake_;
    std::chrono::milliseconds period_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::array<Files, purposes> watched_;
    Files seen_;  ///< In the look before.
    Changes changes_{};
    bool is_ending_ = false;
    std::thread thread_;
};

}  // namespace relief::tools
