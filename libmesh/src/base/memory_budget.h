// SPDX-License-Identifier: Apache-2.0
/// \file
/// The memory that the decoded contents of one file may take, in proportion to its bytes.
/// Tests: tests/mesh/io/gltf/gltf_budget_test.cpp, tests/mesh/io/image/texture_file_test.cpp.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// A small file can stand for much more memory than it has bytes: by arrays without data, by
/// references to the same data, or by compression. Readers draw from the budget of the file before
/// they decode such contents. Contents that are decoded one after the other count as well, because
/// the budget also limits the time.
class MemoryBudget {
  public:
    /// No limit, for contents that were not read from a file.
    MemoryBudget() = default;

    /// The larger of 256 times the bytes of the file and 256 MiB, or the limit of the process
    /// instead of the latter if it was set (relief/mesh/limits.h).
    explicit MemoryBudget(std::uint64_t file_bytes);

    /// Draws `count` times `size` bytes.
    /// \param name  returns what needs them: "accessors[3]"; only called for the message
    /// \throws InvalidInput if less is left
    template <typename Name>
    void take(std::uint64_t count, std::uint64_t size, const Name& name) {
        if (!fits(count, size)) refuse(name());
    }

    [[nodiscard]] std::uint64_t limit() const { return limit_; }

  private:
    bool fits(std::uint64_t count, std::uint64_t size);
    [[noreturn]] void refuse(const std::string& name) const;

    std::uint64_t file_bytes_ = 0;
    std::uint64_t limit_ = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t taken_ = 0;
};

}  // namespace detail
}  // namespace relief
