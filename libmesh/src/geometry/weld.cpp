// SPDX-License-Identifier: Apache-2.0
// Exact welding by an open-addressed hash table of those that may not be alone. Vertices enter it
// in ascending order, so that the first of a class, the one that stays in the table, is the one
// with the smallest index. Tests: tests/mesh/geometry/weld_test.cpp.
#include "geometry/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "parallel.h"

namespace relief {
namespace {

constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();

/// The multiply-and-shift mixer of [Steele et al. 2014]: every bit of the input moves every bit of
/// the result, so that regular grids of floats do not pile up in the table.
std::uint64_t mixed(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
    return bits ^ (bits >> 31);
}

/// A hash that is equal for equal keys: adding +0 turns -0 into +0.
template <std::size_t N>
std::uint64_t hash_of(const std::array<float, N>& key) {
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < N; i += 2) {
        const std::uint64_t low = std::bit_cast<std::uint32_t>(key[i] + 0.0F);
        const std::uint64_t high = i + 1 < N ? std::bit_cast<std::uint32_t>(key[i + 1] + 0.0F) : 0U;
        hash = mixed(hash + (low | high << 32) + 0x9e3779b97f4a7c15ULL);
    }
    return hash;
}

/// A quicker one of 32 bits, which compilers do for several keys at once: good enough to tell most
/// keys apart, not all.
template <std::size_t N>
std::uint32_t quick_hash_of(const std::array<float, N>& key) {
    std::uint32_t hash = 0;
    // Turned in between: signs, the highest bits, would cancel otherwise, on every symmetric mesh.
    for (std::size_t i = 0; i < N; ++i)
        hash = (std::rotl(hash, 15) ^ std::bit_cast<std::uint32_t>(key[i] + 0.0F)) * 0x9e3779b1U;
    hash = (hash ^ (hash >> 15)) * 0xc2b2ae3dU;
    return hash ^ (hash >> 16);
}

/// Tells whether a hash has been seen once or more often; errs towards more often.
class SeenTwice {
  public:
    explicit SeenTwice(std::size_t count)
        : mask_(std::bit_ceil(slots_each * count + 64) - 1), words_((mask_ + 1) / slots_a_word) {}

    void see(std::uint32_t hash) {
        std::uint64_t& word = words_[(hash & mask_) / slots_a_word];
        const std::uint64_t once = std::uint64_t(1) << 2 * (hash % slots_a_word);
        // The upper of two bits is set where the lower one was already.
        word |= once | (word & once) << 1;
    }
    [[nodiscard]] bool twice(std::uint32_t hash) const {
        return (words_[(hash & mask_) / slots_a_word] >> (2 * (hash % slots_a_word) + 1) & 1) != 0;
    }

  private:
    static constexpr std::size_t slots_each = 8;  // One in nine is taken for another by mistake.
    static constexpr std::size_t slots_a_word = 32;
    std::uint64_t mask_;
    std::vector<std::uint64_t> words_;
};

/// `key_of(i)` gives the numbers of vertex i as an array of floats.
///
/// Most vertices are alone, and two bits each, which fit the second cache, are enough to see that.
/// Only the others go through a hash table.
template <typename KeyOf>
std::vector<std::uint32_t> weld(std::size_t count, const KeyOf& key_of) {
    constexpr std::size_t at_once = 128;
    std::array<std::uint32_t, at_once> hashes;
    const auto for_hashes = [&](const auto& use) {
        for (std::size_t first = 0; first < count; first += at_once) {
            const std::size_t size = std::min(at_once, count - first);
            for (std::size_t i = 0; i < size; ++i)
                hashes[i] = quick_hash_of(key_of(first + i));
            for (std::size_t i = 0; i < size; ++i)
                use(first + i, hashes[i]);
        }
    };
    SeenTwice seen(count);
    for_hashes([&](std::size_t, std::uint32_t hash) { seen.see(hash); });
    std::vector<std::uint32_t> representatives(count);
    std::vector<std::uint32_t> candidates;
    for_hashes([&](std::size_t i, std::uint32_t hash) {
        representatives[i] = static_cast<std::uint32_t>(i);
        if (seen.twice(hash)) candidates.push_back(static_cast<std::uint32_t>(i));
    });

    const std::size_t slots = std::bit_ceil(2 * candidates.size() + 1);
    std::vector<std::uint32_t> table(slots, nobody);
    for (const std::uint32_t i : candidates) {
        const auto key = key_of(i);
        if (key != key) continue;  // A NaN: alone, and not in the table, where it would pile up.
        std::size_t slot = hash_of(key) & (slots - 1);
        while (table[slot] != nobody && key_of(table[slot]) != key)
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == nobody) table[slot] = i;
        representatives[i] = table[slot];
    }
    return representatives;
}

}  // namespace

std::vector<std::uint32_t> weld_positions(std::span<const glm::vec3> positions) {
    return weld(positions.size(), [&](std::size_t i) {
        const glm::vec3& p = positions[i];
        return std::array{p.x, p.y, p.z};
    });
}

std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> positions,
                                         std::span<const glm::vec3> normals,
                                         std::span<const glm::vec2> texcoords) {
    return weld(positions.size(), [&](std::size_t i) {
        const glm::vec3& p = positions[i];
        const glm::vec3& n = normals[i];
        const glm::vec2& t = texcoords[i];
        return std::array{p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y};
    });
}

Groups groups_of(std::span<const std::uint32_t> representatives) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;  // Representative, member.
    for (std::size_t i = 0; i < representatives.size(); ++i) {
        if (representatives[i] != i)
            shared.emplace_back(representatives[i], static_cast<std::uint32_t>(i));
    }
    if (shared.empty()) return {};
    std::sort(shared.begin(), shared.end());
    Groups groups;
    for (std::size_t i = 0; i < shared.size(); ++i) {
        if (i == 0 || shared[i].first != shared[i - 1].first) {
            groups.first.push_back(static_cast<std::uint32_t>(groups.members.size()));
            groups.members.push_back(shared[i].first);
        }
        groups.members.push_back(shared[i].second);
    }
    groups.first.push_back(static_cast<std::uint32_t>(groups.members.size()));
    return groups;
}

std::vector<glm::uvec3> welded_triangles(std::span<const glm::uvec3> triangles,
                                         std::span<const std::uint32_t> representatives) {
    std::vector<glm::uvec3> welded(triangles.size());
    parallel_for(triangles.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::uvec3& triangle = triangles[i];
            welded[i] = {representatives[triangle.x], representatives[triangle.y],
                         representatives[triangle.z]};
        }
    });
    return welded;
}

}  // namespace relief
