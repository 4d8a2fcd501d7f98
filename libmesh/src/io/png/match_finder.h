// SPDX-License-Identifier: Apache-2.0
/// \file
/// Repetitions in bytes: what deflate says as "so many bytes from so far back". Source:
/// [Ziv and Lempel 1977], with the limits of [RFC 1951].
/// Tests: tests/mesh/io/png/deflate_encoder_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "relief/mesh/image_file.h"

namespace relief {

inline constexpr std::size_t deflate_window = 32768;
inline constexpr std::size_t longest_match = 258;

/// Bytes as they are, then a repetition; the last of a block may have none (length 0).
struct Sequence {
    std::uint32_t literals = 0;
    std::uint16_t length = 0;
    std::uint16_t distance = 0;
};

/// What a byte costs where it stands for itself, in 1/16 bits.
using LiteralCosts = std::array<std::uint16_t, 256>;

/// Finds repetitions in a piece of memory, block by block.
class MatchFinder {
  public:
    /// \param bytes  all that may be pointed back to: what went before, then what is to be coded
    /// \param begin  where that begins
    /// \param costs  a repetition is taken where it is believed to be shorter than its bytes are
    MatchFinder(std::span<const std::uint8_t> bytes, std::size_t begin, const LiteralCosts& costs,
                WriteEffort effort);

    /// The sequences of the next block, which ends where it has enough symbols, or all bytes do.
    /// \return where that is
    std::size_t next_block(std::size_t most_symbols, std::vector<Sequence>& sequences);

  private:
    struct Match {
        std::size_t length = 0;
        std::size_t distance = 0;
        int saved = 0;  ///< In 1/16 bits.
    };
    /// How far the effort goes.
    struct Limits {
        int candidates;           ///< Places that are looked at; 1 takes the first that pays.
        std::size_t nice_length;  ///< Long enough to look no further.
        int patience;             ///< Of so many bits: bytes without any before steps get larger.
        std::size_t step;         ///< Of all places within a repetition, how many are left out.
    };
    static Limits limits_of(WriteEffort effort);

    std::uint32_t exchange(std::size_t at, std::uint64_t start);
    void know_to(std::size_t end, std::size_t step);
    /// The best that begins here, which is known from now on.
    Match search(std::size_t at);
    /// The best that begins at `at`, or a little later where that one is better.
    Match take(std::size_t& at);

    std::span<const std::uint8_t> bytes_;
    std::size_t next_;
    std::size_t known_;  ///< What begins here or later cannot be pointed to yet.
    const LiteralCosts& costs_;
    Limits limits_;
    std::size_t hashed_bytes_;             ///< Shorter ones are not looked for.
    std::vector<std::uint32_t> newest_;    ///< By hash: one more than the position; 0 for none.
    std::vector<std::uint32_t> previous_;  ///< By position modulo the window: the one before.
};

}  // namespace relief
