// SPDX-License-Identifier: Apache-2.0
/// \file
/// The other end of a Progress: what work says to it, and where it looks up.
///
/// Everything here does nothing, at the price of one look at a thread's variable, where nobody
/// waits. Tests: tests/mesh/base/progress_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "relief/mesh/progress.h"

namespace relief {

/// Whom this thread reports to; null: nobody.
extern constinit thread_local Progress* current_progress;

/// \throws Cancelled if that is wished
inline void check_cancelled() {
    if (current_progress != nullptr && current_progress->is_cancelled()) throw Cancelled();
}

/// For loops that are not shared out: looks up at every 65536th element.
inline void check_cancelled(std::size_t index) {
    if ((index & 0xFFFF) == 0) check_cancelled();
}

/// A file is about to be read, or asked for. Files that are opened by the house's own means
/// (file_bytes.h, random_access_file.h) are noted there.
void note_file(const std::filesystem::path& file);

/// A stage of the work while it lives; those within it take its place meanwhile. Begun inside a
/// loop that is shared out it says nothing, since several would speak at once.
class ProgressStage {
  public:
    /// \param total  of whatever advance() counts; 0: nobody knows
    explicit ProgressStage(const char* name, std::size_t total = 0);
    ~ProgressStage();
    ProgressStage(const ProgressStage&) = delete;
    ProgressStage& operator=(const ProgressStage&) = delete;

    /// So much more is done. From any thread. \throws Cancelled if that is wished
    void advance(std::size_t count);

    /// For loops that are not shared out and count the stage's total: looks up at every 65536th
    /// element. \throws Cancelled likewise
    void at(std::size_t index) {
        if ((index & 0xFFFF) == 0 && index > 0) advance(0x10000);
    }

  private:
    Progress* progress_;
    bool speaks_;
    Progress::Stage before_;
    std::size_t done_before_ = 0;
};

/// A piece of a loop that was shared out by a thread that reports to `progress`.
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

}  // namespace relief
