// SPDX-License-Identifier: Apache-2.0
// Thread-local variables hold the Progress and the limit of threads of an operation; parallel loops
// pass the Progress on to their threads.
#include "relief/mesh/execution.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "parallel.h"
#include "progress_stage.h"

namespace relief {
using namespace relief::detail;

constinit thread_local Progress* detail::current_progress = nullptr;
constinit thread_local unsigned detail::current_thread_limit = 0;

namespace {

constinit thread_local bool is_in_piece = false;

}  // namespace

Progress::State Progress::state() const {
    const std::lock_guard lock(mutex_);
    State state{stage_.name, std::nullopt};
    if (stage_.total > 0) {
        const auto done = static_cast<double>(done_.load(std::memory_order_relaxed));
        state.part = std::min(done / static_cast<double>(stage_.total), 1.0);
    }
    return state;
}

std::map<std::filesystem::path, FileStamp> Progress::files() const {
    const std::lock_guard lock(mutex_);
    return files_;
}

/// \return the previous stage
Progress::Stage Progress::begin(Stage stage) {
    {
        const std::lock_guard lock(mutex_);
        std::swap(stage, stage_);
    }
    told_ = -1;
    return stage;
}

void Progress::advance(std::size_t count) {
    const std::size_t done = done_.fetch_add(count, std::memory_order_relaxed) + count;
    // A stage changes only while no thread advances it.
    if (!tell_ || stage_.total == 0) return;
    const auto percent = static_cast<int>(100 * done / stage_.total);
    if (told_.exchange(percent, std::memory_order_relaxed) != percent) tell();
}

void Progress::tell() {
    if (!tell_) return;
    const std::lock_guard lock(telling_);
    tell_(state());
}

void detail::note_file(const std::filesystem::path& file) {
    Progress* const progress = current_progress;
    if (progress == nullptr) return;
    std::error_code error;
    std::filesystem::path absolute = std::filesystem::absolute(file, error).lexically_normal();
    const FileStamp stamp = stamp_of(absolute);
    const std::lock_guard lock(progress->mutex_);
    progress->files_.try_emplace(std::move(absolute), stamp);
}

ProgressStage::ProgressStage(const char* name, std::size_t total)
    : progress_(current_progress), reports_(progress_ != nullptr && !is_in_piece) {
    check_cancelled();
    if (!reports_) return;
    done_before_ = progress_->done_.exchange(0);
    before_ = progress_->begin({name, total});
    progress_->tell();
}

ProgressStage::~ProgressStage() {
    if (!reports_) return;
    progress_->done_ = done_before_;
    progress_->begin(std::move(before_));
}

void ProgressStage::advance(std::size_t count) {
    if (progress_ == nullptr) return;
    if (reports_) progress_->advance(count);
    if (progress_->is_cancelled()) throw Cancelled();
}

ProgressScope::ProgressScope(Progress& progress)
    : before_(std::exchange(current_progress, &progress)) {}

ProgressScope::~ProgressScope() {
    current_progress = before_;
}

ExecutionScope::ExecutionScope(const ExecutionOptions& options)
    : limit_before_(current_thread_limit), progress_before_(current_progress) {
    if (options.threads > 0) {
        current_thread_limit =
            static_cast<unsigned>(std::min<std::size_t>(options.threads, thread_count()));
    }
    if (options.progress != nullptr) current_progress = options.progress;
}

ExecutionScope::~ExecutionScope() {
    current_thread_limit = limit_before_;
    current_progress = progress_before_;
}

ProgressPiece::ProgressPiece(Progress* progress)
    : before_(std::exchange(current_progress, progress)),
      was_piece_(std::exchange(is_in_piece, true)) {}

ProgressPiece::~ProgressPiece() {
    current_progress = before_;
    is_in_piece = was_piece_;
}

}  // namespace relief
