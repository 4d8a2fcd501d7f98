// SPDX-License-Identifier: Apache-2.0
// Decompression and checksums. This is the only file that uses libdeflate and ISA-L.
#include "io/png/inflate.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <utility>

namespace relief {
namespace {

struct Free {
    void operator()(libdeflate_decompressor* all) const { libdeflate_free_decompressor(all); }
};

}  // namespace

bool inflate(std::span<const std::byte> stream, std::span<std::byte> to) {
    const std::unique_ptr<libdeflate_decompressor, Free> decompressor(
        libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    // Without an output for the actual size, a wrong size is an error.
    return libdeflate_zlib_decompress(decompressor.get(), stream.data(), stream.size(), to.data(),
                                      to.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
    return crc32_of_more(0, bytes);
}

std::uint32_t crc32_of_more(std::uint32_t before, std::span<const std::byte> bytes) {
    return libdeflate_crc32(before, bytes.data(), bytes.size());
}

std::uint32_t adler32(std::span<const std::byte> bytes) {
    return libdeflate_adler32(1, bytes.data(), bytes.size());
}

std::uint32_t adler32_of_both(std::uint32_t first, std::uint32_t second, std::size_t second_size) {
    // The low half is 1 plus the sum of all bytes. The high half is the sum of the low half after
    // each byte, so the contribution of the first range to the low half counts once for each byte
    // of the second.
    constexpr std::uint64_t modulus = 65521;
    const std::uint64_t low_first = first & 0xFFFFU, low_second = second & 0xFFFFU;
    const std::uint64_t low = (low_first + low_second + modulus - 1) % modulus;
    const std::uint64_t carried = (low_first + modulus - 1) % modulus * (second_size % modulus);
    const std::uint64_t high = ((first >> 16) + (second >> 16) + carried) % modulus;
    return static_cast<std::uint32_t>(high << 16 | low);
}

struct InflateStream::Implementation {
    Feed feed;
    std::span<const std::byte> input;  ///< The rest of the last feed.
    inflate_state state{};

    /// Inflates into `to` until it is full or the stream ends. `damaged` tells whether the stream
    /// is invalid. \return the number of bytes of `to` that are left
    std::size_t left_after(std::span<std::byte> to, bool& damaged) {
        while (!to.empty() && state.block_state != ISAL_BLOCK_FINISH) {
            if (input.empty()) input = feed();
            constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
            const auto given = static_cast<std::uint32_t>(std::min(input.size(), most));
            const auto room = static_cast<std::uint32_t>(std::min(to.size(), most));
            // The parameter of ISA-L is not const, but ISA-L does not write to its input.
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
