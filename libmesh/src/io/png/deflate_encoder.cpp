// SPDX-License-Identifier: Apache-2.0
// Blocks of deflate: bytes -> sequences -> how often each symbol occurs -> codes -> bits; or, where
// that would be longer, the bytes as they are. A piece that does not end the stream ends with an
// empty stored block, which brings it to a whole byte. No floating point: the same bits on every
// machine. Source: [RFC 1951]. Tests: tests/mesh/io/png/deflate_encoder_test.cpp.
#include "io/png/deflate_encoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "io/png/huffman_code.h"

namespace relief {
namespace {

using ByteValues = std::span<const std::uint8_t>;

constexpr std::size_t longest_stored = 65535;
constexpr std::size_t symbols_per_block = 65000;
constexpr std::size_t literal_symbols = 286;
constexpr std::size_t distance_symbols = 30;
constexpr std::size_t end_of_block = 256;
constexpr std::size_t first_length_symbol = 257;
/// Four codes of this length and 7 bits that are still to be written fit into 64.
constexpr int longest_code = 14;

using Counts = std::array<std::uint32_t, 256>;

/// How often each byte occurs. Four tables, for equal bytes in a row would wait for one another.
Counts byte_counts(ByteValues bytes) {
    std::array<Counts, 4> tables{};
    std::size_t at = 0;
    for (; at + 4 <= bytes.size(); at += 4) {
        for (std::size_t k = 0; k < 4; ++k)
            ++tables[k][bytes[at + k]];
    }
    for (; at < bytes.size(); ++at)
        ++tables[0][bytes[at]];
    for (std::size_t value = 0; value < 256; ++value)
        tables[0][value] += tables[1][value] + tables[2][value] + tables[3][value];
    return tables[0];
}

/// 256 times the binary logarithm, rounded down: bit by bit, from whether the square is 2 or more.
std::uint32_t log2_in_256ths(std::uint32_t value) {
    const auto whole = static_cast<std::uint32_t>(std::bit_width(value)) - 1;
    std::uint64_t mantissa = std::uint64_t{value} << (31 - whole);  // In [2^31, 2^32).
    std::uint32_t fraction = 0;
    for (int bit = 0; bit < 8; ++bit) {
        mantissa = mantissa * mantissa >> 31;
        const bool carry = mantissa >= std::uint64_t{1} << 32;
        fraction = fraction << 1 | (carry ? 1U : 0U);
        if (carry) mantissa >>= 1;
    }
    return whole << 8 | fraction;
}

LiteralCosts costs_of(const Counts& counts, std::size_t total) {
    LiteralCosts costs{};
    const std::uint32_t all =
        log2_in_256ths(static_cast<std::uint32_t>(std::max<std::size_t>(total, 1)));
    for (std::size_t value = 0; value < 256; ++value) {
        const std::uint32_t own = log2_in_256ths(std::max(counts[value], 1U));
        costs[value] = static_cast<std::uint16_t>(std::max((all - own) / 16, 16U));
    }
    return costs;
}

// ---------------------------------------------------------------------------------------------
// Symbols

/// A length or distance as deflate says it: a symbol, and bits that say where in its class.
struct Class {
    std::uint32_t symbol;
    int extra_bits;
    std::uint32_t extra;
};

/// Classes of lengths: 8 of one, then four of each size 2, 4, 8, 16 and 32; 258 has its own.
Class length_class(std::uint32_t length) {
    if (length == longest_match) return {285, 0, 0};
    const std::uint32_t offset = length - 3;
    if (offset < 8) return {static_cast<std::uint32_t>(first_length_symbol) + offset, 0, 0};
    const int bits = static_cast<int>(std::bit_width(offset)) - 3;
    const auto size = static_cast<std::uint32_t>(bits);
    return {261 + 4 * size + (offset >> size) - 4, bits, offset & ((1U << size) - 1)};
}

/// Classes of distances: 4 of one, then two of each power of two.
Class distance_class(std::uint32_t distance) {
    const std::uint32_t offset = distance - 1;
    if (offset < 4) return {offset, 0, 0};
    const int bits = static_cast<int>(std::bit_width(offset)) - 2;
    const auto size = static_cast<std::uint32_t>(bits);
    return {2 + 2 * size + (offset >> size) - 2, bits, offset & ((1U << size) - 1)};
}

struct SymbolCounts {
    std::array<std::uint32_t, literal_symbols> literals{};
    std::array<std::uint32_t, distance_symbols> distances{};
    std::uint64_t extra_bits = 0;
};

SymbolCounts symbol_counts(ByteValues block, std::span<const Sequence> sequences) {
    SymbolCounts counts;
    std::size_t at = 0;
    for (const Sequence& sequence : sequences) {
        for (const std::size_t end = at + sequence.literals; at < end; ++at)
            ++counts.literals[block[at]];
        if (sequence.length == 0) continue;
        const Class length = length_class(sequence.length);
        const Class distance = distance_class(sequence.distance);
        ++counts.literals[length.symbol];
        ++counts.distances[distance.symbol];
        counts.extra_bits += static_cast<std::uint64_t>(length.extra_bits + distance.extra_bits);
        at += sequence.length;
    }
    counts.literals[end_of_block] = 1;
    return counts;
}

SymbolCounts symbol_counts(const Counts& bytes) {
    SymbolCounts counts;
    std::copy(bytes.begin(), bytes.end(), counts.literals.begin());
    counts.literals[end_of_block] = 1;
    return counts;
}

// ---------------------------------------------------------------------------------------------
// Bits

/// Bits, the first lowest, into memory that has room for them and 8 bytes more.
class BitWriter {
  public:
    explicit BitWriter(std::uint8_t* to) : to_(to) {}

    /// At most 57 bits at once.
    void put(std::uint64_t bits, int count) {
        add(bits, count);
        flush();
    }
    /// Without writing: at most 64 bits may gather.
    void add(std::uint64_t bits, int count) {
        pending_ |= bits << count_;
        count_ += count;
    }
    void flush() {
        std::memcpy(to_, &pending_, sizeof pending_);  // Little-endian, as x86 and ARM are.
        const int whole = count_ / 8;
        to_ += whole;
        pending_ = whole == 8 ? 0 : pending_ >> (8 * whole);
        count_ -= 8 * whole;
    }
    void to_whole_byte() { put(0, (8 - count_) & 7); }
    void put_bytes(ByteValues bytes) {
        if (bytes.empty()) return;  // Whose data may be null, which memcpy may not be given.
        std::memcpy(to_, bytes.data(), bytes.size());
        to_ += bytes.size();
    }
    [[nodiscard]] int pending() const { return count_; }
    [[nodiscard]] std::uint8_t* end() const { return to_; }

  private:
    std::uint8_t* to_;
    std::uint64_t pending_ = 0;
    int count_ = 0;
};

/// A code for each symbol of one alphabet.
template <std::size_t Size>
struct Code {
    std::array<std::uint8_t, Size> lengths{};
    std::array<std::uint16_t, Size> codes{};

    Code() = default;
    Code(const std::array<std::uint32_t, Size>& counts, int most) {
        huffman_lengths(counts, most, lengths);
        huffman_codes(lengths, codes);
    }
    void put(BitWriter& out, std::size_t symbol) const { out.add(codes[symbol], lengths[symbol]); }
    [[nodiscard]] std::uint64_t bits(const std::array<std::uint32_t, Size>& counts) const {
        std::uint64_t sum = 0;
        for (std::size_t symbol = 0; symbol < Size; ++symbol)
            sum += std::uint64_t{counts[symbol]} * lengths[symbol];
        return sum;
    }
};

// ---------------------------------------------------------------------------------------------
// A block's header: the lengths of its codes, coded themselves

/// The lengths in a row, where runs are a symbol each.
struct LengthRun {
    std::uint8_t symbol;
    std::uint8_t extra;
};

constexpr std::size_t run_symbols = 19;
constexpr std::array<int, run_symbols> run_extra_bits{0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                      0, 0, 0, 0, 0, 0, 2, 3, 7};

void append_run(std::vector<LengthRun>& runs, std::uint8_t length, std::size_t count) {
    while (length == 0 && count >= 11) {
        const std::size_t taken = std::min<std::size_t>(count, 138);
        runs.push_back({18, static_cast<std::uint8_t>(taken - 11)});
        count -= taken;
    }
    if (length == 0 && count >= 3) {
        runs.push_back({17, static_cast<std::uint8_t>(count - 3)});
        return;
    }
    if (length > 0 && count > 0) {
        runs.push_back({length, 0});
        --count;
        while (count >= 3) {
            const std::size_t taken = std::min<std::size_t>(count, 6);
            runs.push_back({16, static_cast<std::uint8_t>(taken - 3)});
            count -= taken;
        }
    }
    runs.insert(runs.end(), count, {length, 0});
}

/// All that stands before the symbols of a block with codes of its own.
struct Header {
    std::size_t literals = 0;  ///< How many lengths are said.
    std::size_t distances = 0;
    std::size_t order_count = 0;
    std::vector<LengthRun> runs;
    Code<run_symbols> code;
    std::uint64_t bits = 0;
};

constexpr std::array<std::uint8_t, run_symbols> run_order{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                          11, 4,  12, 3, 13, 2, 14, 1, 15};

template <std::size_t Size>
std::size_t said_lengths(const std::array<std::uint8_t, Size>& lengths, std::size_t least) {
    std::size_t count = Size;
    while (count > least && lengths[count - 1] == 0)
        --count;
    return count;
}

Header header_for(const Code<literal_symbols>& literals, const Code<distance_symbols>& distances) {
    Header header;
    header.literals = said_lengths(literals.lengths, first_length_symbol);
    header.distances = said_lengths(distances.lengths, 1);
    std::vector<std::uint8_t> lengths(
        literals.lengths.begin(),
        literals.lengths.begin() + static_cast<std::ptrdiff_t>(header.literals));
    lengths.insert(lengths.end(), distances.lengths.begin(),
                   distances.lengths.begin() + static_cast<std::ptrdiff_t>(header.distances));
    for (std::size_t at = 0; at < lengths.size();) {
        std::size_t end = at;
        while (end < lengths.size() && lengths[end] == lengths[at])
            ++end;
        append_run(header.runs, lengths[at], end - at);
        at = end;
    }
    std::array<std::uint32_t, run_symbols> counts{};
    for (const LengthRun& run : header.runs)
        ++counts[run.symbol];
    header.code = Code<run_symbols>(counts, 7);
    header.order_count = run_symbols;
    while (header.order_count > 4 && header.code.lengths[run_order[header.order_count - 1]] == 0)
        --header.order_count;
    header.bits = 14 + 3 * header.order_count + header.code.bits(counts);
    for (const LengthRun& run : header.runs)
        header.bits += static_cast<std::uint64_t>(run_extra_bits[run.symbol]);
    return header;
}

void put_header(BitWriter& out, const Header& header) {
    out.put(header.literals - first_length_symbol, 5);
    out.put(header.distances - 1, 5);
    out.put(header.order_count - 4, 4);
    for (std::size_t at = 0; at < header.order_count; ++at)
        out.put(header.code.lengths[run_order[at]], 3);
    for (const LengthRun& run : header.runs) {
        header.code.put(out, run.symbol);
        out.put(run.extra, run_extra_bits[run.symbol]);
    }
}

// ---------------------------------------------------------------------------------------------
// Blocks

void put_literals(BitWriter& out, ByteValues literals, const Code<literal_symbols>& code) {
    std::size_t at = 0;
    for (; at + 4 <= literals.size(); at += 4) {
        for (std::size_t k = 0; k < 4; ++k)
            code.put(out, literals[at + k]);
        out.flush();
    }
    for (; at < literals.size(); ++at)
        code.put(out, literals[at]);
    out.flush();
}

void put_symbols(BitWriter& out, ByteValues block, std::span<const Sequence> sequences,
                 const Code<literal_symbols>& literals, const Code<distance_symbols>& distances) {
    std::size_t at = 0;
    for (const Sequence& sequence : sequences) {
        put_literals(out, block.subspan(at, sequence.literals), literals);
        at += sequence.literals;
        if (sequence.length == 0) continue;
        const Class length = length_class(sequence.length);
        const Class distance = distance_class(sequence.distance);
        literals.put(out, length.symbol);
        out.add(length.extra, length.extra_bits);
        distances.put(out, distance.symbol);
        out.add(distance.extra, distance.extra_bits);
        out.flush();
        at += sequence.length;
    }
    literals.put(out, end_of_block);
    out.flush();
}

void put_stored(BitWriter& out, ByteValues bytes, bool is_last) {
    do {
        const ByteValues block = bytes.first(std::min(bytes.size(), longest_stored));
        bytes = bytes.subspan(block.size());
        out.put(is_last && bytes.empty() ? 1 : 0, 3);
        out.to_whole_byte();
        out.put(block.size(), 16);
        out.put(~block.size() & 0xFFFFU, 16);
        out.put_bytes(block);
    } while (!bytes.empty());
}

/// Bits of bytes as they are.
std::uint64_t stored_bits(std::size_t size) {
    return 8 * size + 40 * ((size + longest_stored - 1) / longest_stored);
}

void put_block(BitWriter& out, ByteValues block, std::span<const Sequence> sequences,
               bool is_last) {
    const bool has_matches = sequences.size() > 1;
    const SymbolCounts counts =
        has_matches ? symbol_counts(block, sequences) : symbol_counts(byte_counts(block));
    const Code<literal_symbols> literals(counts.literals, longest_code);
    const Code<distance_symbols> distances(counts.distances, longest_code);
    const Header header = header_for(literals, distances);
    const std::uint64_t bits = 3 + header.bits + literals.bits(counts.literals) +
                               distances.bits(counts.distances) + counts.extra_bits;
    if (bits >= stored_bits(block.size())) return put_stored(out, block, is_last);
    constexpr std::uint64_t own_codes = 2;
    out.put((is_last ? 1 : 0) | own_codes << 1, 3);
    put_header(out, header);
    put_symbols(out, block, sequences, literals, distances);
}

}  // namespace

void deflate_piece(std::span<const std::uint8_t> bytes, std::size_t begin, WriteEffort effort,
                   Repetitions repetitions, bool is_last, std::vector<std::uint8_t>& to) {
    const std::size_t size = bytes.size() - begin;
    const std::size_t old_size = to.size();
    to.resize(old_size + size + 6 * (2 * size / longest_stored + 4) + 16);
    BitWriter out(to.data() + old_size);
    LiteralCosts costs;
    std::optional<MatchFinder> finder;
    if (repetitions == Repetitions::sought) {
        costs = costs_of(byte_counts(bytes.subspan(begin)), size);
        finder.emplace(bytes, begin, costs, effort);
    }
    std::vector<Sequence> sequences;
    do {
        std::size_t end = std::min(begin + symbols_per_block, bytes.size());
        sequences.clear();
        if (finder)
            end = finder->next_block(symbols_per_block, sequences);
        else
            sequences.push_back({static_cast<std::uint32_t>(end - begin), 0, 0});
        put_block(out, bytes.subspan(begin, end - begin), sequences,
                  is_last && end == bytes.size());
        begin = end;
    } while (begin < bytes.size());
    if (is_last)
        out.to_whole_byte();
    else
        put_stored(out, {}, false);
    to.resize(static_cast<std::size_t>(out.end() - to.data()));
}

std::uint64_t estimated_bits(std::span<const std::uint8_t> bytes, Repetitions repetitions) {
    const Counts counts = byte_counts(bytes);
    if (repetitions == Repetitions::ignored) {
        const SymbolCounts symbols = symbol_counts(counts);
        return Code<literal_symbols>(symbols.literals, longest_code).bits(symbols.literals);
    }
    const LiteralCosts costs = costs_of(counts, bytes.size());
    std::vector<Sequence> sequences;
    MatchFinder(bytes, 0, costs, WriteEffort::fast).next_block(bytes.size() + 1, sequences);
    const SymbolCounts symbols = symbol_counts(bytes, sequences);
    return Code<literal_symbols>(symbols.literals, longest_code).bits(symbols.literals) +
           Code<distance_symbols>(symbols.distances, longest_code).bits(symbols.distances) +
           symbols.extra_bits;
}

}  // namespace relief
