// SPDX-License-Identifier: Apache-2.0
// A grid of cells so small that all within one are near each other: a cell is joined as a whole,
// and two cells at the first pair of vertices that is near. Cells are told apart by whole numbers
// held in double, which stay apart for as long as floats do.
// Tests: tests/mesh/geometry/weld_near_test.cpp.
#include "geometry/weld_near.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "geometry/direction.h"
#include "geometry/disjoint_sets.h"

namespace relief {
namespace {

using CellKey = std::array<double, 3>;

struct HashOfCell {
    std::size_t operator()(const CellKey& key) const {
        std::size_t hash = 0;
        for (const double number : key)
            hash = (hash ^ std::hash<double>{}(number)) * 0x9e3779b97f4a7c15ULL + (hash >> 31);
        return hash;
    }
};

/// Cells in order of their first vertex, and what is in them.
struct Cells {
    std::unordered_map<CellKey, std::uint32_t, HashOfCell> index;
    std::vector<CellKey> keys;
    std::vector<std::vector<std::uint32_t>> vertices;
};

Cells cells_of(std::span<const glm::vec3> positions, double size) {
    Cells cells;
    cells.index.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!is_finite(positions[i])) continue;
        CellKey key;
        for (std::size_t k = 0; k < 3; ++k)
            key[k] = std::floor(positions[i][static_cast<int>(k)] / size) + 0.0;
        const auto [found, is_new] =
            cells.index.try_emplace(key, static_cast<std::uint32_t>(cells.keys.size()));
        if (is_new) {
            cells.keys.push_back(key);
            cells.vertices.emplace_back();
        }
        cells.vertices[found->second].push_back(static_cast<std::uint32_t>(i));
    }
    return cells;
}

bool any_near(std::span<const glm::vec3> positions, std::span<const std::uint32_t> some,
              std::span<const std::uint32_t> others, double tolerance) {
    return std::any_of(some.begin(), some.end(), [&](std::uint32_t a) {
        return std::any_of(others.begin(), others.end(), [&](std::uint32_t b) {
            return glm::distance(glm::dvec3(positions[a]), glm::dvec3(positions[b])) <= tolerance;
        });
    });
}

/// Half of the cells that may hold something near, so that each pair is looked at once.
std::vector<CellKey> offsets_onwards() {
    constexpr int reach = 2;  // The tolerance is sqrt(3) cells long.
    std::vector<CellKey> offsets;
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -reach; z <= reach; ++z) {
                if (std::array{x, y, z} > std::array{0, 0, 0})
                    offsets.push_back({double(x), double(y), double(z)});
            }
        }
    }
    return offsets;
}

}  // namespace

std::vector<std::uint32_t> weld_near_positions(std::span<const glm::vec3> positions,
                                               double tolerance) {
    // A little less than sqrt(3) to the tolerance, so that rounding joins none that are too far.
    const double size = tolerance / 1.7320509;
    const Cells cells = cells_of(positions, size);
    DisjointSets sets(positions.size());
    for (const std::vector<std::uint32_t>& together : cells.vertices) {
        for (const std::uint32_t vertex : together)
            sets.join(together.front(), vertex);
    }
    const std::vector<CellKey> onwards = offsets_onwards();
    for (std::size_t c = 0; c < cells.keys.size(); ++c) {
        const std::vector<std::uint32_t>& here = cells.vertices[c];
        for (const CellKey& offset : onwards) {
            const CellKey& key = cells.keys[c];
            const auto there = cells.index.find(
                {key[0] + offset[0] + 0.0, key[1] + offset[1] + 0.0, key[2] + offset[2] + 0.0});
            if (there == cells.index.end() || there->second == c) continue;
            const std::vector<std::uint32_t>& others = cells.vertices[there->second];
            if (sets.find(here.front()) == sets.find(others.front())) continue;
            if (any_near(positions, here, others, tolerance))
                sets.join(here.front(), others.front());
        }
    }
    std::vector<std::uint32_t> representatives(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        representatives[i] = sets.find(static_cast<std::uint32_t>(i));
    return representatives;
}

}  // namespace relief
