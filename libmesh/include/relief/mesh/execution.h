// SPDX-License-Identifier: Apache-2.0
/// \file
/// The execution of functions: precision, number of threads, progress, cancellation, and memory for
/// intermediate results. Tests: tests/mesh/base/progress_test.cpp,
/// tests/mesh/io/mesh/mesh_file_test.cpp, tests/mesh/geometry/workspace_test.cpp.
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

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

namespace detail {
class ProgressStage;
void note_file(const std::filesystem::path& file);
class WorkMemory;
}  // namespace detail

/// The floating-point type of a computation. Each option of this type documents its accuracy and
/// time.
enum class Arithmetic { float64, float32 };

template <>
inline constexpr auto enum_names<Arithmetic> = std::to_array<EnumName<Arithmetic>>(
    {{"float64", Arithmetic::float64}, {"float32", Arithmetic::float32}});

/// Sets the maximum number of threads of relief's parallel loops in this process, including the
/// calling thread. Results do not depend on it. Programs call it once, when they start; the limit
/// of a single operation is an argument (ExecutionOptions).
///
/// \param count  at least 1; 0 means the number of hardware threads
void set_thread_limit(unsigned count);

// Progress reporting and cancellation for long operations, and a record of the files that they
// read.
//
//     Progress progress;
//     // Worker thread:
//     const ProgressScope scope(progress);
//     MeshFile mesh = read_mesh(file, report);  // May throw Cancelled.
//     // Another thread, meanwhile:
//     show(progress.state());
//     progress.cancel();
//
// The functions that compute on the caller's memory have an argument of type ExecutionOptions. For
// all others, everything that a thread calls during the lifetime of a ProgressScope or an
// ExecutionScope obeys it, including parallel loops. Without a scope nothing is counted, and
// nothing is slower. Readers of meshes, glTF and images, normals, tangents, and the preparation of
// a Renderer report progress.

/// Thrown after Progress::cancel(). The operation has no effect: nothing is written, and existing
/// data is unchanged.
class Cancelled : public Error {
  public:
    Cancelled() : Error("cancelled") {}
};

/// The state of a file when it was opened.
struct FileStamp {
    std::int64_t changed = 0;  ///< Time of change in nanoseconds; only for comparison.
    std::uint64_t size = 0;
    std::uint64_t node = 0;  ///< 0 if the file does not exist.

    bool operator==(const FileStamp&) const = default;
};

/// Returns the current state of a file; symbolic links are followed.
FileStamp stamp_of(const std::filesystem::path& file);

/// The progress of an operation. All functions may be called from any thread.
class Progress {
  public:
    struct State {
        std::string stage;  ///< "reading", "parsing", ...; empty before and after the operation.
        /// The finished fraction of the stage, 0 to 1; absent if it is unknown.
        std::optional<double> part;
    };

    Progress() = default;
    /// \param tell  called when the stage changes and at each percent of it, from a worker thread,
    ///         one call at a time
    explicit Progress(std::function<void(const State&)> tell) : tell_(std::move(tell)) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Requests cancellation: the operation throws Cancelled, usually within a few milliseconds,
    /// and at the latest after one image, one upload or one indivisible step of a file.
    void cancel() noexcept { is_cancelled_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool is_cancelled() const noexcept {
        return is_cancelled_.load(std::memory_order_relaxed);
    }

    [[nodiscard]] State state() const;

    /// Every file that was opened, or searched and not found, with its state before it was read.
    [[nodiscard]] std::map<std::filesystem::path, FileStamp> files() const;

  private:
    friend class detail::ProgressStage;
    friend void detail::note_file(const std::filesystem::path& file);

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

/// Directs the progress of everything that this thread calls to `progress`, which must outlive the
/// scope. In nested scopes, the innermost one receives it.
class ProgressScope {
  public:
    explicit ProgressScope(Progress& progress);
    ~ProgressScope();
    ProgressScope(const ProgressScope&) = delete;
    ProgressScope& operator=(const ProgressScope&) = delete;

  private:
    Progress* before_;
};

/// The execution of one operation. Operations with different options may run at the same time; the
/// results do not depend on the options.
struct ExecutionOptions {
    /// The maximum number of threads, including the calling one. 0: no limit but that of the
    /// process (set_thread_limit()) and of enclosing scopes.
    unsigned threads = 0;
    /// Receives the progress and can cancel the operation, which then throws Cancelled. It must
    /// live until the operation returns. Null: that of the enclosing scope, if there is one.
    Progress* progress = nullptr;
};

/// Applies options to everything that this thread calls during its lifetime. In nested scopes, the
/// smallest limit and the innermost Progress apply. Only the acceleration structures of bakes,
/// which Embree builds, ignore the limit of threads.
class ExecutionScope {
  public:
    explicit ExecutionScope(const ExecutionOptions& options);
    ~ExecutionScope();
    ExecutionScope(const ExecutionScope&) = delete;
    ExecutionScope& operator=(const ExecutionScope&) = delete;

  private:
    unsigned limit_before_;
    Progress* progress_before_;
};

/// Memory for intermediate results, which normals and tangents leave to the next call. The system
/// clears new memory at its first use, which costs up to a tenth of the time.
///
///     Workspace workspace;
///     for (each frame) {
///         const WorkspaceScope scope(workspace);
///         vertex_normals(positions, triangles, {}, normals);
///     }
///
/// Operations of several threads may share it; each has memory of its own then.
class Workspace {
  public:
    Workspace() = default;
    ~Workspace();
    Workspace(const Workspace&) = delete;
    Workspace& operator=(const Workspace&) = delete;

    /// The number of bytes that wait for the next call: at most what the calls so far used at once.
    [[nodiscard]] std::size_t size() const;
    /// Frees them.
    void clear();

  private:
    friend class detail::WorkMemory;

    struct Block {
        void* memory = nullptr;
        std::size_t size = 0;
    };
    Block take(std::size_t size);
    void give_back(const Block& block) noexcept;

    mutable std::mutex mutex_;
    std::vector<Block> free_;  ///< Ascending by size.
    std::size_t taken_ = 0;
};

/// Lets everything that this thread calls use `workspace`, which must outlive the scope. In nested
/// scopes, the innermost one is used. Results do not depend on it.
class WorkspaceScope {
  public:
    explicit WorkspaceScope(Workspace& workspace);
    ~WorkspaceScope();
    WorkspaceScope(const WorkspaceScope&) = delete;
    WorkspaceScope& operator=(const WorkspaceScope&) = delete;

  private:
    Workspace* before_;
};

}  // namespace relief
