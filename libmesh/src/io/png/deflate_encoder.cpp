// SPDX-License-Identifier: Apache-2.0
// An encoder of deflate streams: prefix codes [Huffman 1952], repetitions [Ziv and Lempel 1977],
// and blocks of both [RFC 1951].
#include "io/png/png_format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <optional>

namespace relief::detail {
namespace {

constexpr std::size_t max_symbols = 288;
constexpr int max_deflate_length = 15;

/// A leaf or an inner node of the tree.
struct Node {
    std::uint32_t count = 0;
    std::uint16_t symbol = 0;  ///< Only for leaves.
    std::uint16_t parent = 0;
};

/// Builds the tree. Leaves come first, sorted by count; inner nodes follow in order of creation,
/// which is also sorted by count. Each step merges the two rarest nodes at the heads of both
/// queues.
void build_tree(std::span<Node> nodes, std::size_t leaves) {
    std::size_t leaf = 0, inner = leaves;
    for (std::size_t made = leaves; made < 2 * leaves - 1; ++made) {
        std::uint32_t count = 0;
        for (int child = 0; child < 2; ++child) {
            const bool take_leaf =
                leaf < leaves && (inner >= made || nodes[leaf].count <= nodes[inner].count);
            Node& taken = nodes[take_leaf ? leaf++ : inner++];
            taken.parent = static_cast<std::uint16_t>(made);
            count += taken.count;
        }
        nodes[made].count = count;
    }
}

/// Returns the number of codes of each length, none longer than `max_length`.
std::array<int, 64> length_counts(std::span<const Node> nodes, std::size_t leaves, int max_length) {
    std::array<int, 64> used{};
    std::array<std::uint8_t, 2 * max_symbols> depth{};
    const std::size_t root = 2 * leaves - 2;
    for (std::size_t at = root; at-- > 0;) {
        depth[at] = static_cast<std::uint8_t>(depth[nodes[at].parent] + 1);
        if (at < leaves) ++used[static_cast<std::size_t>(std::min<int>(depth[at], max_length))];
    }
    // The shortened codes exceed the available space. Until they fit, a code of maximum length
    // moves below the longest code that can still grow.
    std::uint64_t room = 0;
    for (int length = 1; length <= max_length; ++length)
        room += static_cast<std::uint64_t>(used[static_cast<std::size_t>(length)])
                << (max_length - length);
    for (; room > std::uint64_t{1} << max_length; --room) {
        --used[static_cast<std::size_t>(max_length)];
        int grown = max_length - 1;
        while (used[static_cast<std::size_t>(grown)] == 0)
            --grown;
        --used[static_cast<std::size_t>(grown)];
        used[static_cast<std::size_t>(grown) + 1] += 2;
    }
    return used;
}

std::uint16_t reversed(std::uint32_t code, int length) {
    std::uint32_t result = 0;
    for (int bit = 0; bit < length; ++bit)
        result |= (code >> bit & 1U) << (length - 1 - bit);
    return static_cast<std::uint16_t>(result);
}

}  // namespace

void huffman_lengths(std::span<const std::uint32_t> counts, int max_length,
                     std::span<std::uint8_t> lengths) {
    assert(counts.size() <= max_symbols && counts.size() >= 2);
    std::array<Node, 2 * max_symbols> nodes;
    std::size_t leaves = 0;
    for (std::size_t symbol = 0; symbol < counts.size(); ++symbol) {
        if (counts[symbol] > 0)
            nodes[leaves++] = {counts[symbol], static_cast<std::uint16_t>(symbol), 0};
    }
    for (std::uint16_t symbol = 0; leaves < 2; ++symbol) {
        if (counts[symbol] == 0) nodes[leaves++] = {0, symbol, 0};
    }
    std::sort(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(leaves),
              [](const Node& a, const Node& b) {
                  return a.count != b.count ? a.count < b.count : a.symbol < b.symbol;
              });
    build_tree(nodes, leaves);
    std::array<int, 64> used = length_counts(nodes, leaves, max_length);
    std::fill(lengths.begin(), lengths.end(), std::uint8_t{0});
    int length = max_length;
    for (std::size_t leaf = 0; leaf < leaves;
         ++leaf) {  // The rarest symbols get the longest codes.
        while (used[static_cast<std::size_t>(length)] == 0)
            --length;
        --used[static_cast<std::size_t>(length)];
        lengths[nodes[leaf].symbol] = static_cast<std::uint8_t>(length);
    }
}

void huffman_codes(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes) {
    std::array<std::uint32_t, max_deflate_length + 1> used{};
    for (const std::uint8_t length : lengths)
        ++used[length];
    used[0] = 0;
    std::array<std::uint32_t, max_deflate_length + 1> next{};
    for (std::size_t length = 1; length < next.size(); ++length)
        next[length] = (next[length - 1] + used[length - 1]) << 1U;
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        const int length = lengths[symbol];
        codes[symbol] = length == 0 ? std::uint16_t{0}
                                    : reversed(next[static_cast<std::size_t>(length)]++, length);
    }
}

namespace {

constexpr std::size_t max_match = 258;

/// Literal bytes, then a repetition; the last one of a block may have none (length 0).
struct Sequence {
    std::uint32_t literals = 0;
    std::uint16_t length = 0;
    std::uint16_t distance = 0;
};

/// The cost of each byte as a literal, in 1/16 bits.
using LiteralCosts = std::array<std::uint16_t, 256>;

/// Finds repetitions in a range of memory, block by block.
class MatchFinder {
  public:
    /// \param bytes  the preceding bytes, to which repetitions can refer, and the bytes to encode
    /// \param begin  index of the first byte to encode
    /// \param costs  a repetition is used if its estimated cost is below that of its bytes as
    ///         literals
    MatchFinder(std::span<const std::uint8_t> bytes, std::size_t begin, const LiteralCosts& costs,
                WriteEffort effort);

    /// Finds the sequences of the next block, which ends when it has enough symbols, or at the end
    /// of the bytes.
    /// \return the end of the block
    std::size_t next_block(std::size_t max_block_symbols, std::vector<Sequence>& sequences);

  private:
    struct Match {
        std::size_t length = 0;
        std::size_t distance = 0;
        int saved = 0;  ///< In 1/16 bits.
    };
    /// Parameters of an effort.
    struct Limits {
        int candidates;           ///< Positions to compare; with 1 the first useful one is taken.
        std::size_t nice_length;  ///< A match of this length ends the search.
        int patience;             ///< Log2 of the number of literals after which steps grow.
        std::size_t step;         ///< Steps between inserted positions within a match.
    };
    static Limits limits_of(WriteEffort effort);

    std::uint32_t insert(std::size_t at, std::uint64_t start);
    void insert_until(std::size_t end, std::size_t step);
    /// The best match at a position, which is inserted.
    Match search(std::size_t at);
    /// The best match at `at`, or at a position shortly after it if that is better.
    Match best_match(std::size_t& at);

    std::span<const std::uint8_t> bytes_;
    std::size_t next_;
    std::size_t inserted_;  ///< First position that is not in the hash table.
    const LiteralCosts& costs_;
    Limits limits_;
    std::size_t hashed_bytes_;           ///< Shorter matches are not found.
    std::vector<std::uint32_t> newest_;  ///< By hash: position + 1 of the newest entry; 0 for none.
    std::vector<std::uint32_t> previous_;  ///< By position modulo the window: the entry before it.
};

constexpr int hash_bits = 15;
constexpr std::size_t min_hashed = 4;
constexpr std::size_t max_hashed = 8;

std::uint64_t eight_bytes(const std::uint8_t* at) {
    std::uint64_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// Returns the length of the common prefix, up to `max_length`.
std::size_t common_length(const std::uint8_t* a, const std::uint8_t* b, std::size_t max_length) {
    std::size_t length = 0;
    for (; length + 8 <= max_length; length += 8) {
        std::uint64_t left = 0, right = 0;
        std::memcpy(&left, a + length, sizeof left);
        std::memcpy(&right, b + length, sizeof right);
        if (left != right)
            return length + static_cast<std::size_t>(std::countr_zero(left ^ right)) / 8;
    }
    while (length < max_length && a[length] == b[length])
        ++length;
    return length;
}

/// Returns the estimated cost of a match in 1/16 bits: typical code lengths plus the extra bits of
/// its length and distance.
int match_cost(std::size_t length, std::size_t distance) {
    constexpr int codes = 11;
    const int length_bits = length < 11 ? 0 : static_cast<int>(std::bit_width(length - 3)) - 3;
    const int distance_bits = std::max(static_cast<int>(std::bit_width(distance - 1)) - 2, 0);
    return 16 * (codes + length_bits + distance_bits);
}

/// Estimated from the first eight bytes, which must exist.
int nominal_cost(const std::uint8_t* bytes, std::size_t length, const LiteralCosts& costs) {
    int sum = 0;
    for (std::size_t i = 0; i < 8; ++i)
        sum += costs[bytes[i]];
    return sum * static_cast<int>(length) / 8;
}

/// Length from which a match one or two rows away is useful, at the mean cost of a byte.
std::size_t min_match_length(std::span<const std::uint8_t> bytes, const LiteralCosts& costs) {
    constexpr std::size_t stride =
        61;  // Enough samples for the mean; not a multiple of texel sizes.
    constexpr std::size_t usual_cost = 16 * 20;
    std::size_t sum = 0, count = 0;
    for (std::size_t at = 0; at < bytes.size(); at += stride, ++count)
        sum += costs[bytes[at]];
    return count == 0 ? min_hashed : std::clamp(usual_cost * count / sum, min_hashed, max_hashed);
}

MatchFinder::MatchFinder(std::span<const std::uint8_t> bytes, std::size_t begin,
                         const LiteralCosts& costs, WriteEffort effort)
    : bytes_(bytes),
      next_(begin),
      inserted_(begin < deflate_window ? 0 : begin - deflate_window),
      costs_(costs),
      limits_(limits_of(effort)),
      hashed_bytes_(effort == WriteEffort::small ? min_hashed
                                                 : min_match_length(bytes.subspan(begin), costs)),
      newest_(std::size_t{1} << hash_bits, 0),
      previous_(limits_.candidates > 1 ? deflate_window : 0) {
    insert_until(begin, 1);
}

MatchFinder::Limits MatchFinder::limits_of(WriteEffort effort) {
    switch (effort) {
        case WriteEffort::fast:
            return {1, 16, 3, 4};
        case WriteEffort::normal:
            return {1, 32, 4, 1};
        case WriteEffort::small:
            break;
    }
    return {256, max_match, 30, 1};
}

/// Replaces the newest position with the same hash by this one. \return the old one
inline std::uint32_t MatchFinder::insert(std::size_t at, std::uint64_t start) {
    const std::uint64_t hashed = start << (64 - 8 * hashed_bytes_);
    std::uint32_t& newest = newest_[hashed * 0x9E3779B97F4A7C15U >> (64 - hash_bits)];
    const std::uint32_t candidate = newest;
    newest = static_cast<std::uint32_t>(at + 1);
    if (!previous_.empty()) previous_[at % deflate_window] = candidate;
    return candidate;
}

void MatchFinder::insert_until(std::size_t end, std::size_t step) {
    const std::size_t last = bytes_.size() < max_hashed ? 0 : bytes_.size() - max_hashed + 1;
    for (; inserted_ < std::min(end, last); inserted_ += step)
        insert(inserted_, eight_bytes(bytes_.data() + inserted_));
    inserted_ = std::max(inserted_, end);
}

MatchFinder::Match MatchFinder::search(std::size_t at) {
    Match best;
    if (at + max_hashed > bytes_.size()) return best;
    const std::uint8_t* const here = bytes_.data() + at;
    const std::uint64_t start = eight_bytes(here);
    std::uint32_t candidate = insert(at, start);
    inserted_ = at + 1;
    const std::size_t max_length = std::min(max_match, bytes_.size() - at);
    const int unhashed_bits = static_cast<int>(64 - 8 * hashed_bytes_);
    std::size_t longest = 0;
    for (int left = limits_.candidates; left > 0 && candidate > 0; --left) {
        const std::size_t from = candidate - 1;
        if (at - from > deflate_window) break;
        const std::uint8_t* const there = bytes_.data() + from;
        if ((eight_bytes(there) ^ start) << unhashed_bits == 0 && there[longest] == here[longest]) {
            const std::size_t length = common_length(here, there, max_length);
            const std::size_t distance = at - from;
            if (length > longest) {
                longest = length;
                const int saved = nominal_cost(here, length, costs_) - match_cost(length, distance);
                if (saved > best.saved) best = {length, distance, saved};
            }
            if (length >= limits_.nice_length || length == max_length) break;
        }
        if (previous_.empty()) break;
        const std::uint32_t next = previous_[from % deflate_window];
        if (next >= candidate) break;  // The entry was overwritten by a later one.
        candidate = next;
    }
    return best;
}

MatchFinder::Match MatchFinder::best_match(std::size_t& at) {
    Match match = search(at);
    if (match.length == 0 || limits_.candidates == 1) return match;
    while (match.length < limits_.nice_length) {
        const Match later = search(at + 1);
        if (later.saved <= match.saved + costs_[bytes_[at]] / 2) break;
        match = later;
        ++at;
    }
    return match;
}

std::size_t MatchFinder::next_block(std::size_t max_block_symbols,
                                    std::vector<Sequence>& sequences) {
    constexpr std::size_t max_step = 16;
    std::size_t symbols = 0;
    std::size_t literals_from = next_;
    std::size_t at = next_;
    while (at < bytes_.size() && symbols + (at - literals_from) < max_block_symbols) {
        const Match match = best_match(at);
        if (match.length == 0) {
            at += std::min(((at - literals_from) >> limits_.patience) + 1, max_step);
            continue;
        }
        sequences.push_back({static_cast<std::uint32_t>(at - literals_from),
                             static_cast<std::uint16_t>(match.length),
                             static_cast<std::uint16_t>(match.distance)});
        symbols += at - literals_from + 1;
        at += match.length;
        insert_until(at, match.length > limits_.nice_length ? 8 : limits_.step);
        literals_from = at;
    }
    next_ = std::min(at, bytes_.size());
    sequences.push_back({static_cast<std::uint32_t>(next_ - literals_from), 0, 0});
    return next_;
}

using ByteValues = std::span<const std::uint8_t>;

constexpr std::size_t max_stored = 65535;
constexpr std::size_t symbols_per_block = 65000;
constexpr std::size_t literal_symbols = 286;
constexpr std::size_t distance_symbols = 30;
constexpr std::size_t end_of_block = 256;
constexpr std::size_t first_length_symbol = 257;
/// Four codes of this length and 7 pending bits fit into 64 bits.
constexpr int max_code_length = 14;

using Counts = std::array<std::uint32_t, 256>;

/// Counts each byte. Four tables avoid dependencies between equal neighbors.
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

/// Returns 256 times the binary logarithm, rounded down. Each bit tells whether the square is at
/// least 2.
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

// --- Symbols ---

/// A length or distance as deflate encodes it: a symbol, and extra bits for the position in its
/// class.
struct Class {
    std::uint32_t symbol;
    int extra_bits;
    std::uint32_t extra;
};

/// Classes of lengths: 8 of one value, then four each of 2, 4, 8, 16 and 32 values; 258 has its
/// own.
Class length_class(std::uint32_t length) {
    if (length == max_match) return {285, 0, 0};
    const std::uint32_t offset = length - 3;
    if (offset < 8) return {static_cast<std::uint32_t>(first_length_symbol) + offset, 0, 0};
    const int bits = static_cast<int>(std::bit_width(offset)) - 3;
    const auto size = static_cast<std::uint32_t>(bits);
    return {261 + 4 * size + (offset >> size) - 4, bits, offset & ((1U << size) - 1)};
}

/// Classes of distances: 4 of one value, then two for each power of two.
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

// --- Bits ---

/// Writes bits, the first lowest, into memory that has room for them and 8 more bytes.
class BitWriter {
  public:
    explicit BitWriter(std::uint8_t* to) : to_(to) {}

    /// Adds at most 57 bits and writes complete bytes.
    void put(std::uint64_t bits, int count) {
        add(bits, count);
        flush();
    }
    /// Adds bits without writing; at most 64 bits can be pending.
    void add(std::uint64_t bits, int count) {
        pending_ |= bits << count_;
        count_ += count;
    }
    void flush() {
        std::memcpy(to_, &pending_, sizeof pending_);  // Little-endian, as on x86 and ARM.
        const int whole = count_ / 8;
        to_ += whole;
        pending_ = whole == 8 ? 0 : pending_ >> (8 * whole);
        count_ -= 8 * whole;
    }
    void align_to_byte() { put(0, (8 - count_) & 7); }
    void put_bytes(ByteValues bytes) {
        if (bytes.empty()) return;  // The data pointer may be null, which memcpy does not allow.
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

/// A prefix code of one alphabet.
template <std::size_t Size>
struct Code {
    std::array<std::uint8_t, Size> lengths{};
    std::array<std::uint16_t, Size> codes{};

    Code() = default;
    Code(const std::array<std::uint32_t, Size>& counts, int max_length) {
        huffman_lengths(counts, max_length, lengths);
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

// --- The header of a block: the encoded lengths of its codes ---

/// Code lengths with run-length coding.
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

/// The header of a block with dynamic codes.
struct Header {
    std::size_t literals = 0;  ///< Number of lengths that are stored.
    std::size_t distances = 0;
    std::size_t order_count = 0;
    std::vector<LengthRun> runs;
    Code<run_symbols> code;
    std::uint64_t bits = 0;
};

constexpr std::array<std::uint8_t, run_symbols> run_order{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                          11, 4,  12, 3, 13, 2, 14, 1, 15};

template <std::size_t Size>
std::size_t coded_length_count(const std::array<std::uint8_t, Size>& lengths, std::size_t least) {
    std::size_t count = Size;
    while (count > least && lengths[count - 1] == 0)
        --count;
    return count;
}

Header header_for(const Code<literal_symbols>& literals, const Code<distance_symbols>& distances) {
    Header header;
    header.literals = coded_length_count(literals.lengths, first_length_symbol);
    header.distances = coded_length_count(distances.lengths, 1);
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

// --- Blocks ---

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
        const ByteValues block = bytes.first(std::min(bytes.size(), max_stored));
        bytes = bytes.subspan(block.size());
        out.put(is_last && bytes.empty() ? 1 : 0, 3);
        out.align_to_byte();
        out.put(block.size(), 16);
        out.put(~block.size() & 0xFFFFU, 16);
        out.put_bytes(block);
    } while (!bytes.empty());
}

/// Bits of a stored block.
std::uint64_t stored_bits(std::size_t size) {
    return 8 * size + 40 * ((size + max_stored - 1) / max_stored);
}

void put_block(BitWriter& out, ByteValues block, std::span<const Sequence> sequences,
               bool is_last) {
    const bool has_matches = sequences.size() > 1;
    const SymbolCounts counts =
        has_matches ? symbol_counts(block, sequences) : symbol_counts(byte_counts(block));
    const Code<literal_symbols> literals(counts.literals, max_code_length);
    const Code<distance_symbols> distances(counts.distances, max_code_length);
    const Header header = header_for(literals, distances);
    const std::uint64_t bits = 3 + header.bits + literals.bits(counts.literals) +
                               distances.bits(counts.distances) + counts.extra_bits;
    if (bits >= stored_bits(block.size())) return put_stored(out, block, is_last);
    constexpr std::uint64_t dynamic_codes = 2;
    out.put((is_last ? 1 : 0) | dynamic_codes << 1, 3);
    put_header(out, header);
    put_symbols(out, block, sequences, literals, distances);
}

}  // namespace

void deflate_piece(std::span<const std::uint8_t> bytes, std::size_t begin, WriteEffort effort,
                   Repetitions repetitions, bool is_last, std::vector<std::uint8_t>& to) {
    const std::size_t size = bytes.size() - begin;
    const std::size_t old_size = to.size();
    to.resize(old_size + size + 6 * (2 * size / max_stored + 4) + 16);
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
        out.align_to_byte();
    else
        put_stored(out, {}, false);
    to.resize(static_cast<std::size_t>(out.end() - to.data()));
}

std::uint64_t estimated_bits(std::span<const std::uint8_t> bytes, Repetitions repetitions) {
    const Counts counts = byte_counts(bytes);
    if (repetitions == Repetitions::ignored) {
        const SymbolCounts symbols = symbol_counts(counts);
        return Code<literal_symbols>(symbols.literals, max_code_length).bits(symbols.literals);
    }
    const LiteralCosts costs = costs_of(counts, bytes.size());
    std::vector<Sequence> sequences;
    MatchFinder(bytes, 0, costs, WriteEffort::fast).next_block(bytes.size() + 1, sequences);
    const SymbolCounts symbols = symbol_counts(bytes, sequences);
    return Code<literal_symbols>(symbols.literals, max_code_length).bits(symbols.literals) +
           Code<distance_symbols>(symbols.distances, max_code_length).bits(symbols.distances) +
           symbols.extra_bits;
}

}  // namespace relief::detail
