// SPDX-License-Identifier: Apache-2.0
/// \file
/// Progress from the side of the operation: stages, and cancellation points; and its limit of
/// threads.
///
/// Without a Progress, all functions here only read a thread-local variable.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "relief/export.h"
#include "relief/mesh/execution.h"

namespace RELIEF_API relief {
namespace detail {

/// The Progress of this thread; null if there is none.
extern constinit thread_local Progress* current_progress;

/// The limit of threads of the loops that this thread starts; 0 if there is none.
extern constinit thread_local unsigned current_thread_limit;

/// A cancellation point. \throws Cancelled if cancellation was requested
inline void check_cancelled() {
    if (current_progress != nullptr && current_progress->is_cancelled()) throw Cancelled();
}

/// A cancellation point for serial loops, which acts at every 65536th element.
inline void check_cancelled(std::size_t index) {
    if ((index & 0xFFFF) == 0) check_cancelled();
}

/// Records a file that is about to be read. The functions of files.h do this for their files.
void note_file(const std::filesystem::path& file);

/// A stage of the operation during the lifetime of this object; nested stages replace it
/// temporarily. Inside a parallel loop it has no effect, because several stages would be active at
/// once.
class ProgressStage {
  public:
    /// \param total  the sum of all advance() calls; 0 if unknown
    explicit ProgressStage(const char* name, std::size_t total = 0);
    ~ProgressStage();
    ProgressStage(const ProgressStage&) = delete;
    ProgressStage& operator=(const ProgressStage&) = delete;

    /// Reports progress, from any thread. \throws Cancelled if cancellation was requested
    void advance(std::size_t count);

    /// Reports progress of a serial loop over `total` elements, at every 65536th element. \throws
    /// Cancelled likewise
    void at(std::size_t index) {
        if ((index & 0xFFFF) == 0 && index > 0) advance(0x10000);
    }

  private:
    Progress* progress_;
    bool reports_;
    Progress::Stage before_;
    std::size_t done_before_ = 0;
};

/// Marks this thread as working on a piece of a parallel loop whose caller reports to `progress`.
class ProgressPiece {
  public:
    explicit ProgressPiece(Progress* progress);
    ~ProgressPiece();
    ProgressPiece(const ProgressPiece&) = delete;
    ProgressPiece& operator=(const ProgressPiece&) = delete;

  private:
    Progress* before_;
    bool was_piece_;
};

}  // namespace detail
}  // namespace relief
