// SPDX-License-Identifier: Apache-2.0
// Repetitions by hashing four bytes: chains of earlier places with the same hash, searched to a
// depth that the effort sets. Where nothing repeats, ever larger steps are made, for filtered
// samples of normal maps are mostly noise. Whether a repetition pays is judged by what its bytes
// would cost: of noise that packs well a short one is longer than the bytes themselves. Any bytes
// are good input. Tests: tests/mesh/io/png/deflate_encoder_test.cpp.
#include "io/png/match_finder.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace relief {
namespace {

constexpr int hash_bits = 15;
constexpr std::size_t least_hashed = 4;
constexpr std::size_t most_hashed = 8;

std::uint64_t eight_bytes(const std::uint8_t* at) {
    std::uint64_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// How far two places agree, up to `most`.
std::size_t common_length(const std::uint8_t* a, const std::uint8_t* b, std::size_t most) {
    std::size_t length = 0;
    for (; length + 8 <= most; length += 8) {
        std::uint64_t left = 0, right = 0;
        std::memcpy(&left, a + length, sizeof left);
        std::memcpy(&right, b + length, sizeof right);
        if (left != right)
            return length + static_cast<std::size_t>(std::countr_zero(left ^ right)) / 8;
    }
    while (length < most && a[length] == b[length])
        ++length;
    return length;
}

/// What a repetition is believed to cost, in 1/16 bits: usual code lengths, and the bits that say
/// which length and distance of a class are meant.
int match_cost(std::size_t length, std::size_t distance) {
    constexpr int codes = 11;
    const int length_bits = length < 11 ? 0 : static_cast<int>(std::bit_width(length - 3)) - 3;
    const int distance_bits = std::max(static_cast<int>(std::bit_width(distance - 1)) - 2, 0);
    return 16 * (codes + length_bits + distance_bits);
}

/// By the first eight bytes, of which the memory must have so many.
int cost_of(const std::uint8_t* bytes, std::size_t length, const LiteralCosts& costs) {
    int sum = 0;
    for (std::size_t i = 0; i < 8; ++i)
        sum += costs[bytes[i]];
    return sum * static_cast<int>(length) / 8;
}

/// How long a repetition from a row or two away must be to be worth it at the mean cost of a byte.
std::size_t worthwhile_length(std::span<const std::uint8_t> bytes, const LiteralCosts& costs) {
    constexpr std::size_t stride = 61;  // Enough to know the mean, and in step with no texel.
    constexpr std::size_t usual_cost = 16 * 20;
    std::size_t sum = 0, count = 0;
    for (std::size_t at = 0; at < bytes.size(); at += stride, ++count)
        sum += costs[bytes[at]];
    return count == 0 ? least_hashed
                      : std::clamp(usual_cost * count / sum, least_hashed, most_hashed);
}

}  // namespace

MatchFinder::MatchFinder(std::span<const std::uint8_t> bytes, std::size_t begin,
                         const LiteralCosts& costs, WriteEffort effort)
    : bytes_(bytes),
      next_(begin),
      known_(begin < deflate_window ? 0 : begin - deflate_window),
      costs_(costs),
      limits_(limits_of(effort)),
      hashed_bytes_(effort == WriteEffort::small ? least_hashed
                                                 : worthwhile_length(bytes.subspan(begin), costs)),
      newest_(std::size_t{1} << hash_bits, 0),
      previous_(limits_.candidates > 1 ? deflate_window : 0) {
    know_to(begin, 1);
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
    return {256, longest_match, 30, 1};
}

/// The newest place before with the same hash, which gives way to this one.
inline std::uint32_t MatchFinder::exchange(std::size_t at, std::uint64_t start) {
    const std::uint64_t hashed = start << (64 - 8 * hashed_bytes_);
    std::uint32_t& newest = newest_[hashed * 0x9E3779B97F4A7C15U >> (64 - hash_bits)];
    const std::uint32_t candidate = newest;
    newest = static_cast<std::uint32_t>(at + 1);
    if (!previous_.empty()) previous_[at % deflate_window] = candidate;
    return candidate;
}

void MatchFinder::know_to(std::size_t end, std::size_t step) {
    const std::size_t last = bytes_.size() < most_hashed ? 0 : bytes_.size() - most_hashed + 1;
    for (; known_ < std::min(end, last); known_ += step)
        exchange(known_, eight_bytes(bytes_.data() + known_));
    known_ = std::max(known_, end);
}

MatchFinder::Match MatchFinder::search(std::size_t at) {
    Match best;
    if (at + most_hashed > bytes_.size()) return best;
    const std::uint8_t* const here = bytes_.data() + at;
    const std::uint64_t start = eight_bytes(here);
    std::uint32_t candidate = exchange(at, start);
    known_ = at + 1;
    const std::size_t most = std::min(longest_match, bytes_.size() - at);
    const int unhashed_bits = static_cast<int>(64 - 8 * hashed_bytes_);
    std::size_t longest = 0;
    for (int left = limits_.candidates; left > 0 && candidate > 0; --left) {
        const std::size_t from = candidate - 1;
        if (at - from > deflate_window) break;
        const std::uint8_t* const there = bytes_.data() + from;
        if ((eight_bytes(there) ^ start) << unhashed_bits == 0 && there[longest] == here[longest]) {
            const std::size_t length = common_length(here, there, most);
            const std::size_t distance = at - from;
            if (length > longest) {
                longest = length;
                const int saved = cost_of(here, length, costs_) - match_cost(length, distance);
                if (saved > best.saved) best = {length, distance, saved};
            }
            if (length >= limits_.nice_length || length == most) break;
        }
        if (previous_.empty()) break;
        const std::uint32_t next = previous_[from % deflate_window];
        if (next >= candidate) break;  // Its place has been taken by a later one.
        candidate = next;
    }
    return best;
}

MatchFinder::Match MatchFinder::take(std::size_t& at) {
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

std::size_t MatchFinder::next_block(std::size_t most_symbols, std::vector<Sequence>& sequences) {
    constexpr std::size_t largest_step = 16;
    std::size_t symbols = 0;
    std::size_t literals_from = next_;
    std::size_t at = next_;
    while (at < bytes_.size() && symbols + (at - literals_from) < most_symbols) {
        const Match match = take(at);
        if (match.length == 0) {
            at += std::min(((at - literals_from) >> limits_.patience) + 1, largest_step);
            continue;
        }
        sequences.push_back({static_cast<std::uint32_t>(at - literals_from),
                             static_cast<std::uint16_t>(match.length),
                             static_cast<std::uint16_t>(match.distance)});
        symbols += at - literals_from + 1;
        at += match.length;
        know_to(at, match.length > limits_.nice_length ? 8 : limits_.step);
        literals_from = at;
    }
    next_ = std::min(at, bytes_.size());
    sequences.push_back({static_cast<std::uint32_t>(next_ - literals_from), 0, 0});
    return next_;
}

}  // namespace relief
