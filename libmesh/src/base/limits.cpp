// SPDX-License-Identifier: Apache-2.0
// The limits of the process and the budget of a file.
#include "relief/mesh/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "large_memory.h"
#include "memory_budget.h"
#include "operating_system.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

std::atomic<std::uint64_t> memory_limit{0};
std::atomic<std::uint64_t> pixel_limit{0};
std::atomic<bool> permits_outside_files{false};

double mebibytes(std::uint64_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

/// Returns a * b, or the largest number if that is larger.
std::uint64_t saturated_product(std::uint64_t a, std::uint64_t b) {
    std::uint64_t product = 0;
    return __builtin_mul_overflow(a, b, &product) ? ~std::uint64_t{0} : product;
}

}  // namespace

void set_input_limits(const InputLimits& limits) {
    memory_limit = limits.memory;
    pixel_limit = limits.pixels;
    permits_outside_files = limits.outside_files;
}

InputLimits input_limits() {
    static const std::uint64_t default_memory = memory_of_machine() / 4 * 3;
    const std::uint64_t memory = memory_limit;
    return {memory > 0 ? memory : default_memory, pixel_limit, permits_outside_files};
}

void detail::require_memory(std::uint64_t count, std::uint64_t size) {
    const std::uint64_t limit = input_limits().memory;
    const std::uint64_t bytes = saturated_product(count, size);
    if (bytes <= limit) return;
    throw InvalidInput(fmt::format("needs {:.1f} MiB of memory, but the limit is {:.1f}",
                                   mebibytes(bytes), mebibytes(limit)));
}

void detail::require_memory_for(const std::filesystem::path& file, std::uint64_t count,
                                std::uint64_t size) {
    try {
        require_memory(count, size);
    } catch (const InvalidInput& error) {
        throw FileError(file, error.what());
    }
}

void detail::require_pixels(const std::filesystem::path& file, int width, int height) {
    const std::uint64_t limit = input_limits().pixels;
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (limit == 0 || pixels <= limit) return;
    throw FileError(
        file, fmt::format("has {} x {} texels, but the limit is {} texels", width, height, limit));
}

// The budget of a file.

namespace {

/// Draco and meshopt reach a factor of about 100 on regular meshes, and the floats of quantized
/// attributes another one of 2.
constexpr std::uint64_t memory_per_byte = 256;
constexpr std::uint64_t min_budget = std::uint64_t{256} << 20;

}  // namespace

MemoryBudget::MemoryBudget(std::uint64_t file_bytes) : file_bytes_(file_bytes) {
    const std::uint64_t memory = memory_limit;
    limit_ =
        std::max(memory > 0 ? memory : min_budget, saturated_product(file_bytes, memory_per_byte));
}

bool MemoryBudget::fits(std::uint64_t count, std::uint64_t size) {
    if (__builtin_add_overflow(taken_, saturated_product(count, size), &taken_))
        taken_ = std::numeric_limits<std::uint64_t>::max();
    return taken_ <= limit_;
}

void MemoryBudget::refuse(const std::string& name) const {
    throw InvalidInput(fmt::format(
        "{}: the contents of the file up to here take {:.1f} MiB of memory, but a file of {} bytes "
        "may take only {:.1f} (--max-memory raises this limit)",
        name, mebibytes(taken_), file_bytes_, mebibytes(limit_)));
}

}  // namespace relief
