// SPDX-License-Identifier: Apache-2.0
/// \file
/// Blocks made of fields of bits, and the bytes of encoded blocks as a number.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "relief/mesh/block_compression.h"
#include "relief/mesh/execution.h"
#include "support/vector_bits.h"

namespace relief::test {

inline constexpr BlockQuality all_qualities[] = {BlockQuality::fast, BlockQuality::normal,
                                                 BlockQuality::best};

using Blocks = std::vector<std::byte>;

/// A number of `count` bits.
struct Bits {
    unsigned value, count;
};

/// A block of these numbers, lowest bits first.
inline Blocks block_of(std::size_t size, const std::vector<Bits>& fields) {
    Blocks block(size);
    unsigned next = 0;
    for (const Bits& field : fields) {
        for (unsigned i = 0; i < field.count; ++i, ++next)
            block[next / 8] |= static_cast<std::byte>((field.value >> i & 1U) << (next % 8));
    }
    EXPECT_EQ(next, 8 * size);
    return block;
}

/// Returns a hash (FNV-1a) of the bytes after those that `hash` has.
inline std::uint64_t hash_after(std::uint64_t hash, const Blocks& blocks) {
    for (const std::byte byte : blocks)
        hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211ULL;
    return hash;
}

/// Expects the same number for all widths of vectors and any number of threads.
template <typename Fingerprint>
void expect_everywhere(const Fingerprint& fingerprint, std::uint64_t expected) {
    EXPECT_EQ(fingerprint(), expected);
    for (const char* bits : {"128", "256"}) {
        const VectorBits width(bits);
        EXPECT_EQ(fingerprint(), expected) << bits;
    }
    set_thread_limit(1);
    EXPECT_EQ(fingerprint(), expected);
    set_thread_limit(0);
}

}  // namespace relief::test
