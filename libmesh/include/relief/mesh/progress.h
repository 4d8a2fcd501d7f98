// SPDX-License-Identifier: Apache-2.0
/// \file
/// Work that somebody waits for: how far it is, the wish that it ends, and which files it read.
///
///     Progress progress;
///     // One thread:
///     const ProgressScope scope(progress);
///     MeshFile mesh = read_mesh(file, report);  // May throw Cancelled.
///     // Another one, meanwhile:
///     show(progress.state());
///     progress.cancel();
///
/// No function takes a Progress: what a thread calls while it has a ProgressScope reports to it,
/// and so do the loops that it shares out. Without one, nothing is counted and nothing is slower.
/// Readers of meshes, glTF and images, normals, tangents and what a Renderer prepares report to it.
/// Tests: tests/mesh/base/progress_test.cpp, tests/mesh/io/mesh/mesh_file_test.cpp.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/error.h"

namespace relief {

/// Somebody called Progress::cancel(). What was begun is as if it had not been: nothing is written,
/// what was there before is untouched.
class Cancelled : public Error {
  public:
    Cancelled() : Error("cancelled") {}
};

/// How a file looked when it was opened, or that it was not there.
struct FileStamp {
    std::int64_t changed = 0;  ///< Nanoseconds; of no meaning but to be compared.
    std::uint64_t size = 0;
    std::uint64_t node = 0;  ///< 0: there is no such file.

    bool operator==(const FileStamp&) const = default;
};

/// How it looks now; links are followed.
FileStamp stamp_of(const std::filesystem::path& file);

/// All its functions may be called from any thread.
class Progress {
  public:
    struct State {
        std::string stage;           ///< "reading", "parsing", ...; empty before and after any.
        std::optional<double> part;  ///< Of that stage, 0 to 1; absent where nobody can know.
    };

    Progress() = default;
    /// \param tell  called when the stage changes and at each percent of it, from a thread at work,
    ///              one call at a time
    explicit Progress(std::function<void(const State&)> tell) : tell_(std::move(tell)) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// The work throws Cancelled as soon as it looks up: usually within a few milliseconds, and no
    /// later than after one image, one upload or one file's step that cannot be parted.
    void cancel() noexcept { is_cancelled_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool is_cancelled() const noexcept {
        return is_cancelled_.load(std::memory_order_relaxed);
    }

    [[nodiscard]] State state() const;

    /// Every file that was opened, or looked for and not found, with its stamp from before.
    [[nodiscard]] std::map<std::filesystem::path, FileStamp> files() const;

  private:
    friend class ProgressStage;
    friend void note_file(const std::filesystem::path& file);

    struct Stage {
        std::string name;
        std::size_t total = 0;
    };
    Stage begin(Stage stage);
    void advance(std::size_t count);
    void tell();

    std::function<void(const State&)> tell_;
    std::atomic<bool> is_cancelled_{false};
    std::atomic<std::size_t> done_{0};
    std::atomic<int> told_{-1};  ///< In percent.
    mutable std::mutex mutex_;
    Stage stage_;
    std::map<std::filesystem::path, FileStamp> files_;
    std::mutex telling_;
};

/// While it lives, what this thread calls reports to `progress`, which must live longer. The
/// innermost one counts.
class ProgressScope {
  public:
    explicit ProgressScope(Progress& progress);
    ~ProgressScope();
    ProgressScope(const ProgressScope&) = delete;
    ProgressScope& operator=(const ProgressScope&) = delete;

  private:
    Progress* before_;
};

}  // namespace relief
