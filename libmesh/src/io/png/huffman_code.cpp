// SPDX-License-Identifier: Apache-2.0
// Prefix codes: a tree by merging the two rarest again and again, from two queues; its depths;
// depths beyond the limit pulled in; codes in order of length, then symbol. Ties go by symbol, so
// that the same counts give the same code everywhere. Sources: [Huffman 1952], [RFC 1951],
// section 3.2.2. Tests: tests/mesh/io/png/deflate_encoder_test.cpp.
#include "io/png/huffman_code.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace relief {
namespace {

constexpr std::size_t most_symbols = 288;
constexpr int deflate_limit = 15;

/// A leaf or an inner node of the tree.
struct Node {
    std::uint32_t count = 0;
    std::uint16_t symbol = 0;  ///< Of a leaf.
    std::uint16_t parent = 0;
};

/// Leaves come first, rarest first; inner nodes follow in the order in which they are made, which
/// is by rising count as well. Each merge takes the two rarest of both queues' heads.
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

/// How many codes there are of each length, none longer than `most`.
std::array<int, 64> lengths_in_use(std::span<const Node> nodes, std::size_t leaves, int most) {
    std::array<int, 64> used{};
    std::array<std::uint8_t, 2 * most_symbols> depth{};
    const std::size_t root = 2 * leaves - 2;
    for (std::size_t at = root; at-- > 0;) {
        depth[at] = static_cast<std::uint8_t>(depth[nodes[at].parent] + 1);
        if (at < leaves) ++used[static_cast<std::size_t>(std::min<int>(depth[at], most))];
    }
    // Shortened codes take too much room; as long as they do, a pair of the longest ones goes below
    // the longest of those that still can grow.
    std::uint64_t room = 0;
    for (int length = 1; length <= most; ++length)
        room += static_cast<std::uint64_t>(used[static_cast<std::size_t>(length)])
                << (most - length);
    for (; room > std::uint64_t{1} << most; --room) {
        --used[static_cast<std::size_t>(most)];
        int grown = most - 1;
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

void huffman_lengths(std::span<const std::uint32_t> counts, int most,
                     std::span<std::uint8_t> lengths) {
    assert(counts.size() <= most_symbols && counts.size() >= 2);
    std::array<Node, 2 * most_symbols> nodes;
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
    std::array<int, 64> used = lengths_in_use(nodes, leaves, most);
    std::fill(lengths.begin(), lengths.end(), std::uint8_t{0});
    int length = most;
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {  // The rarest get the longest.
        while (used[static_cast<std::size_t>(length)] == 0)
            --length;
        --used[static_cast<std::size_t>(length)];
        lengths[nodes[leaf].symbol] = static_cast<std::uint8_t>(length);
    }
}

void huffman_codes(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes) {
    std::array<std::uint32_t, deflate_limit + 1> used{};
    for (const std::uint8_t length : lengths)
        ++used[length];
    used[0] = 0;
    std::array<std::uint32_t, deflate_limit + 1> next{};
    for (std::size_t length = 1; length < next.size(); ++length)
        next[length] = (next[length - 1] + used[length - 1]) << 1U;
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        const int length = lengths[symbol];
        codes[symbol] = length == 0 ? std::uint16_t{0}
                                    : reversed(next[static_cast<std::size_t>(length)]++, length);
    }
}

}  // namespace relief
