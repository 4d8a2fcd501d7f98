// SPDX-License-Identifier: Apache-2.0
// Chunks, filters, checksums and decompression of PNG files. The loops that apply filters are
// compiled for several vector widths. This is the only file that uses libdeflate and ISA-L.
#include "io/png/png_format.h"
#include "compiler.h"
#include "portable_math.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace relief::detail {

void append_big16(std::string& to, std::uint32_t value) {
    to += static_cast<char>(value >> 8);
    to += static_cast<char>(value);
}

void append_big32(std::string& to, std::uint32_t value) {
    append_big16(to, value >> 16);
    append_big16(to, value);
}

void append_chunk(std::string& file, std::string_view type, std::string_view data) {
    append_big32(file, static_cast<std::uint32_t>(data.size()));
    const std::size_t checked_from = file.size();
    file += type;
    file += data;
    append_big32(file, crc32(std::as_bytes(std::span(file).subspan(checked_from))));
}

namespace {

// --- Undoing filters: each texel needs the one before it, so its bytes are processed at once ---

/// The bytes of a texel, up to eight, as numbers of 16 bits.
using Texel = Vector<std::int16_t, 16>;

using PackedTexel = Vector<std::uint8_t, 8>;

// Integers, because a load of more bytes than the last store wrote waits for that store.
template <std::size_t Step>
RELIEF_INLINE Texel load_texel(const std::uint8_t* bytes) {
    std::uint64_t packed = 0;
    for (std::size_t k = 0; k < Step; ++k)
        packed |= std::uint64_t{bytes[k]} << (8 * k);
    return __builtin_convertvector(std::bit_cast<PackedTexel>(packed), Texel);
}

template <std::size_t Step>
RELIEF_INLINE void store_texel(const Texel& texel, std::uint8_t* bytes) {
    const auto packed = std::bit_cast<std::uint64_t>(__builtin_convertvector(texel, PackedTexel));
    for (std::size_t k = 0; k < Step; ++k)
        bytes[k] = static_cast<std::uint8_t>(packed >> (8 * k));
}

RELIEF_INLINE Texel magnitude(const Texel& value) {
    return value < 0 ? -value : value;
}

/// Returns the nearest to left + above - upper left of left, above and upper left; ties: in this
/// order.
RELIEF_INLINE Texel paeth_prediction(const Texel& left, const Texel& above,
                                     const Texel& upper_left) {
    const Texel across = above - upper_left;
    const Texel down = left - upper_left;
    const Texel from_left = magnitude(across);
    const Texel from_above = magnitude(down);
    const Texel from_corner = magnitude(across + down);
    const Texel other = from_above <= from_corner ? above : upper_left;
    const Texel other_distance = from_above <= from_corner ? from_above : from_corner;
    return from_left <= other_distance ? left : other;
}

/// Processes a row texel by texel; `predict(left, above, upper left)` returns the prediction.
template <std::size_t Step, typename Predict>
RELIEF_INLINE void add_prediction(std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                                  Predict predict) {
    Texel left{};
    Texel corner{};
    for (std::size_t at = 0; at + Step <= size; at += Step) {
        const Texel up = load_texel<Step>(above + at);
        left = (load_texel<Step>(row + at) + predict(left, up, corner)) & 0xFF;
        corner = up;
        store_texel<Step>(left, row + at);
    }
}

template <std::size_t Step>
RELIEF_INLINE bool undo_loop(std::uint8_t filter, std::uint8_t* row, const std::uint8_t* above,
                             std::size_t size) {
    switch (filter) {
        case 0:
            return true;
        case 1:
            add_prediction<Step>(
                row, above, size,
                [](const Texel& left, const Texel&, const Texel&) { return left; });
            return true;
        case 2:
            for (std::size_t i = 0; i < size; ++i)
                row[i] = static_cast<std::uint8_t>(row[i] + above[i]);
            return true;
        case 3:
            add_prediction<Step>(
                row, above, size,
                [](const Texel& left, const Texel& up, const Texel&) { return (left + up) >> 1; });
            return true;
        case paeth_filter:
            add_prediction<Step>(row, above, size, paeth_prediction);
            return true;
        default:
            return false;
    }
}

// --- Applying filters: bytes are independent, so the loops are vectorized ---

using Byte = std::uint8_t;

/// Returns Paeth's prediction in byte arithmetic. If left and above lie on the same side of the
/// corner, their distances from it add up, saturated at 255, which no other distance exceeds;
/// otherwise they are subtracted.
RELIEF_INLINE Byte paeth_of(Byte left, Byte up, Byte corner) {
    const auto from_left = static_cast<Byte>(up > corner ? up - corner : corner - up);
    const auto from_up = static_cast<Byte>(left > corner ? left - corner : corner - left);
    const auto sum = static_cast<Byte>(from_left + from_up);
    const Byte apart = sum < from_left ? Byte{255} : sum;
    const auto together =
        static_cast<Byte>(from_left > from_up ? from_left - from_up : from_up - from_left);
    const Byte from_corner = (left > corner) == (up > corner) ? apart : together;
    const Byte other = from_up <= from_corner ? up : corner;
    const Byte nearest = from_up <= from_corner ? from_up : from_corner;
    return from_left <= nearest ? left : other;
}

struct Rows {
    const Byte* here;
    const Byte* left;
    const Byte* up;
    const Byte* corner;
    Byte* filtered;
    std::size_t size;
};

RELIEF_INLINE void subtract_loop(Byte filter, const Rows& rows) {
    const Byte* __restrict const here = rows.here;
    const Byte* __restrict const left = rows.left;
    const Byte* __restrict const up = rows.up;
    const Byte* __restrict const corner = rows.corner;
    Byte* __restrict const to = rows.filtered;
    const std::size_t size = rows.size;
    switch (filter) {
        case 0:
            for (std::size_t i = 0; i < size; ++i)
                to[i] = here[i];
            return;
        case 1:
            for (std::size_t i = 0; i < size; ++i)
                to[i] = static_cast<Byte>(here[i] - left[i]);
            return;
        case 2:
            for (std::size_t i = 0; i < size; ++i)
                to[i] = static_cast<Byte>(here[i] - up[i]);
            return;
        case 3:  // The mean, rounded down, without a ninth bit.
            for (std::size_t i = 0; i < size; ++i) {
                const auto mean = static_cast<Byte>((left[i] & up[i]) + ((left[i] ^ up[i]) >> 1));
                to[i] = static_cast<Byte>(here[i] - mean);
            }
            return;
        default:
            for (std::size_t i = 0; i < size; ++i)
                to[i] = static_cast<Byte>(here[i] - paeth_of(left[i], up[i], corner[i]));
    }
}

void subtract_any(Byte filter, const Rows& rows) {
    subtract_loop(filter, rows);
}
RELIEF_TARGET_256 void subtract_256(Byte filter, const Rows& rows) {
    subtract_loop(filter, rows);
}
RELIEF_TARGET_512 void subtract_512(Byte filter, const Rows& rows) {
    subtract_loop(filter, rows);
}

template <std::size_t Step>
[[gnu::noinline]] bool undo_any(std::uint8_t filter, std::uint8_t* row, const std::uint8_t* above,
                                std::size_t size) {
    return undo_loop<Step>(filter, row, above, size);
}
template <std::size_t Step>
RELIEF_TARGET_256 bool undo_256(std::uint8_t filter, std::uint8_t* row, const std::uint8_t* above,
                                std::size_t size) {
    return undo_loop<Step>(filter, row, above, size);
}

template <std::size_t Step>
bool undo(std::uint8_t filter, std::span<std::uint8_t> row, std::span<const std::uint8_t> above) {
    const bool has_256 = best_vector_target() != VectorTarget::any;
    return (has_256 ? undo_256<Step> : undo_any<Step>)(filter, row.data(), above.data(),
                                                       row.size());
}

}  // namespace

bool undo_filter(std::uint8_t filter, std::size_t step, std::span<std::uint8_t> row,
                 std::span<const std::uint8_t> above) {
    switch (step) {
        case 1:
            return undo<1>(filter, row, above);
        case 2:
            return undo<2>(filter, row, above);
        case 3:
            return undo<3>(filter, row, above);
        case 4:
            return undo<4>(filter, row, above);
        case 6:
            return undo<6>(filter, row, above);
        default:
            return undo<8>(filter, row, above);
    }
}

void apply_filter(std::uint8_t filter, std::size_t step, std::span<const std::uint8_t> row,
                  std::span<const std::uint8_t> above, std::span<std::uint8_t> filtered) {
    const std::array<Byte, 8> nothing{};  // The left neighbors of the first texel.
    const std::size_t first = std::min(step, row.size());
    subtract_loop(
        filter, {row.data(), nothing.data(), above.data(), nothing.data(), filtered.data(), first});
    const Rows rest{row.data() + first,      row.data(),        above.data() + first, above.data(),
                    filtered.data() + first, row.size() - first};
    switch (best_vector_target()) {
        case VectorTarget::any:
            return subtract_any(filter, rest);
        case VectorTarget::wide:
            return subtract_256(filter, rest);
        case VectorTarget::widest:
            return subtract_512(filter, rest);
    }
}

namespace {

std::vector<std::uint8_t> filtered_by(std::uint8_t filter, std::span<const std::uint8_t> rows,
                                      std::size_t size, std::size_t step) {
    std::vector<std::uint8_t> filtered(rows.size() - size);
    for (std::size_t at = 0; at < filtered.size(); at += size) {
        apply_filter(filter, step, rows.subspan(at + size, size), rows.subspan(at, size),
                     std::span(filtered).subspan(at, size));
    }
    return filtered;
}

/// The saving that repetitions must give, in percent. Bytes with many bits repeat only in short
/// pieces, which are many and slow to find.
std::uint64_t surcharge_in_percent(std::uint64_t bits, std::size_t bytes, WriteEffort effort) {
    const std::uint64_t bits_per_byte_in_percent = 100 * bits / bytes;
    switch (effort) {
        case WriteEffort::fast:
            return bits_per_byte_in_percent / 8;
        case WriteEffort::normal:
            return bits_per_byte_in_percent / 20;
        case WriteEffort::small:
            break;
    }
    return 1;
}

}  // namespace

FilterChoice choose_filter(std::span<const std::uint8_t> rows, std::size_t size, std::size_t step,
                           WriteEffort effort) {
    std::array<std::vector<std::uint8_t>, filter_count> tried;
    FilterChoice best;
    std::uint64_t least = 0;
    const auto consider = [&](std::uint8_t filter, Repetitions repetitions) {
        std::uint64_t bits = estimated_bits(tried[filter], repetitions);
        if (repetitions == Repetitions::sought)
            bits += bits * surcharge_in_percent(bits, tried[filter].size(), effort) / 100;
        if (least > 0 && bits >= least) return;
        least = bits;
        best = {filter, repetitions};
    };
    for (std::uint8_t filter = 0; filter < filter_count; ++filter) {
        tried[filter] = filtered_by(filter, rows, size, step);
        consider(filter, Repetitions::ignored);
    }
    const std::uint8_t plain_best = best.filter;
    consider(plain_best, Repetitions::sought);
    if (plain_best != 0) consider(0, Repetitions::sought);
    if (plain_best != 2) consider(2, Repetitions::sought);
    return best;
}

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

}  // namespace relief::detail
