// SPDX-License-Identifier: Apache-2.0
// Memory that operations give back to a Workspace for the next ones.
//
// An operation takes the smallest block that is large enough. If there is none, the largest block
// is freed and a new one is allocated, so that growing meshes do not leave their smaller blocks
// behind.
#include "relief/mesh/execution.h"

#include <algorithm>
#include <mutex>
#include <new>
#include <utility>

#include "large_memory.h"
#include "work_array.h"

namespace relief {
using namespace relief::detail;

constinit thread_local Workspace* detail::current_workspace = nullptr;

WorkspaceScope::WorkspaceScope(Workspace& workspace)
    : before_(std::exchange(current_workspace, &workspace)) {}

WorkspaceScope::~WorkspaceScope() {
    current_workspace = before_;
}

namespace {

constexpr std::align_val_t alignment{64};

void* allocate(std::size_t size) {
    void* const memory = ::operator new(size, alignment);
    expect_filling(memory, size);
    return memory;
}

}  // namespace

Workspace::~Workspace() {
    clear();
}

void Workspace::clear() {
    const std::lock_guard lock(mutex_);
    for (const Block& block : free_)
        ::operator delete(block.memory, alignment);
    free_.clear();
}

std::size_t Workspace::size() const {
    const std::lock_guard lock(mutex_);
    std::size_t size = 0;
    for (const Block& block : free_)
        size += block.size;
    return size;
}

Workspace::Block Workspace::take(std::size_t size) {
    {
        const std::lock_guard lock(mutex_);
        free_.reserve(free_.size() + ++taken_);
        const auto found = std::find_if(free_.begin(), free_.end(),
                                        [&](const Block& b) { return b.size >= size; });
        if (found != free_.end()) {
            const Block block = *found;
            free_.erase(found);
            return block;
        }
        if (!free_.empty()) {
            ::operator delete(free_.back().memory, alignment);
            free_.pop_back();
        }
    }
    return {allocate(size), size};
}

void Workspace::give_back(const Block& block) noexcept {
    const std::lock_guard lock(mutex_);
    --taken_;
    const auto place = std::find_if(free_.begin(), free_.end(),
                                    [&](const Block& b) { return b.size >= block.size; });
    free_.insert(place, block);  // take() has reserved the room.
}

WorkMemory::WorkMemory(std::size_t size) : workspace_(current_workspace) {
    if (size == 0) return;
    block_ =
        workspace_ != nullptr ? workspace_->take(size) : Workspace::Block{allocate(size), size};
    data_ = block_.memory;
}

WorkMemory::~WorkMemory() {
    if (block_.memory == nullptr) return;
    if (workspace_ != nullptr)
        workspace_->give_back(block_);
    else
        ::operator delete(block_.memory, alignment);
}

}  // namespace relief
