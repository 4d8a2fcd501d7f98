// SPDX-License-Identifier: Apache-2.0
// Exact welding by one open-addressed hash table. Vertices enter it in ascending order, so that the
// first of a class, the one that stays in the table, is the one with the smallest index.
// Tests: tests/mesh/geometry/weld_test.cpp.
#include "geometry/weld.h"

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

/// `key_of(i)` gives the numbers of vertex i as an array of floats.
template <typename KeyOf>
std::vector<std::uint32_t> weld(std::size_t count, const KeyOf& key_of) {
    const std::size_t slots = std::bit_ceil(2 * count + 1);
    std::vector<std::uint32_t> table(slots, nobody);
    std::vector<std::uint32_t> representatives(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        representatives[i] = index;
        const auto key = key_of(i);
        if (key != key) continue;  // A NaN: alone, and not in the table, where it would pile up.
        std::size_t slot = hash_of(key) & (slots - 1);
        while (table[slot] != nobody && key_of(table[slot]) != key)
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == nobody) table[slot] = index;
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
