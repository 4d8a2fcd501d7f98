// SPDX-License-Identifier: Apache-2.0
// zlib streams by ISA-L. Damage of any kind is false, never more. Tests:
// tests/mesh/io/png/inflate_stream_test.cpp.
#include "io/png/inflate_stream.h"

#include <isa-l/igzip_lib.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace relief {

struct InflateStream::Implementation {
    Feed feed;
    std::span<const std::byte> input;  ///< What is left of the last feed.
    inflate_state state{};

    /// Inflates into `to` until it is full or the stream ends. \return what is left of `to`, or
    /// nothing where the stream is damaged
    std::size_t left_after(std::span<std::byte> to, bool& damaged) {
        while (!to.empty() && state.block_state != ISAL_BLOCK_FINISH) {
            if (input.empty()) input = feed();
            constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
            const auto given = static_cast<std::uint32_t>(std::min(input.size(), most));
            const auto room = static_cast<std::uint32_t>(std::min(to.size(), most));
            // ISA-L takes its input as bytes that it might write to, but does not.
            state.next_in =
                const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(input.data()));
            state.avail_in = given;
            state.next_out = reinterpret_cast<std::uint8_t*>(to.data());
            state.avail_out = room;
            const int result = isal_inflate(&state);
            const std::size_t taken = given - state.avail_in;
            const std::size_t made = room - state.avail_out;
            input = input.subspan(taken);
            to = to.subspan(made);
            const bool is_stuck = taken == 0 && made == 0 && state.block_state != ISAL_BLOCK_FINISH;
            damaged = result != ISAL_DECOMP_OK || is_stuck;
            if (damaged) break;
        }
        return to.size();
    }
};

InflateStream::InflateStream(Feed feed) : implementation_(new Implementation) {
    implementation_->feed = std::move(feed);
    isal_inflate_init(&implementation_->state);
    implementation_->state.crc_flag = ISAL_ZLIB;
}

InflateStream::~InflateStream() = default;

bool InflateStream::fill(std::span<std::byte> to) {
    bool damaged = false;
    return implementation_->left_after(to, damaged) == 0 && !damaged;
}

bool InflateStream::is_complete() {
    std::byte too_much{};
    bool damaged = false;
    return implementation_->left_after({&too_much, 1}, damaged) == 1 && !damaged;
}

}  // namespace relief
