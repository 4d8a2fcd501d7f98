// SPDX-License-Identifier: Apache-2.0
// How the bound comes about, in units u = 2^-53 of relative rounding: edges are off by u, an area
// vector therefore by less than 8 u times the largest product of two edges, and a factor's error
// (normal_votes.h) moves the vote by less than 24 u times factor times that product; adding n votes
// in any order moves the sum by n u times what the votes' lengths add up to. A unit vector is off
// by the sum's error over its length, and by 4 u from normalising. The code allows twice that.
// Votes computed in float are taken as they are: there, only adding them up rounds.
// Tests: tests/mesh/geometry/normals/normals_test.cpp.
#include "geometry/normals/normal_rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "parallel.h"
#include "vector_targets.h"

namespace relief {
namespace {

constexpr std::size_t at_once = 128;
constexpr double unit_rounding = 0x1p-53;

struct BlockSums {
    alignas(64) std::array<double, at_once> x, y, z, edge_product, count;
};

struct BlockNormals {
    alignas(64) std::array<float, at_once> x, y, z;
    alignas(64) std::array<std::uint32_t, at_once> doubt;  ///< 1 or 0.
};

/// To the nearest whole number, for |value| < 2^51.
RELIEF_INLINE double nearest(double value) {
    constexpr double large = 0x1.8p52;
    return (value + large) - large;
}

RELIEF_INLINE float to_float(double steps) {
    return static_cast<float>(steps) * static_cast<float>(1.0 / normal_grid) + 0.0F;
}

RELIEF_INLINE void round_block(const BlockSums& sums, BlockNormals& normals) {
    for (std::size_t i = 0; i < at_once; ++i) {
        const double x = sums.x[i], y = sums.y[i], z = sums.z[i];
        const double steps = normal_grid / std::sqrt(x * x + y * y + z * z);
        const double sum_error = (64.0 + 2.0 * sums.count[i]) * sums.edge_product[i] * steps;
        const double safe = 0.5 - unit_rounding * (sum_error + 8.0 * normal_grid);
        const double to_x = nearest(x * steps), to_y = nearest(y * steps),
                     to_z = nearest(z * steps);
        const double off_x = std::abs(x * steps - to_x), off_y = std::abs(y * steps - to_y),
                     off_z = std::abs(z * steps - to_z);
        const double off_xy = off_x > off_y ? off_x : off_y;
        const double off = off_xy > off_z ? off_xy : off_z;
        // Written so that NaN, from a sum of zero, is in doubt; so is a count that ran full.
        const double full = sums.count[i] < 255.0 ? 0.0 : 1.0;
        normals.doubt[i] = off + full < safe ? 0U : 1U;
        normals.x[i] = to_float(to_x);
        normals.y[i] = to_float(to_y);
        normals.z[i] = to_float(to_z);
    }
}

template <typename Take>
RELIEF_INLINE void take_part(const PartialSums& part, std::size_t begin, std::size_t from,
                             std::size_t to, BlockSums& block, const Take& take) {
    for (std::size_t v = from; v < to; ++v) {
        const NormalVoteSum& sum = part.sums()[v];
        take(block.x[v - begin], sum.x);
        take(block.y[v - begin], sum.y);
        take(block.z[v - begin], sum.z);
        take(block.edge_product[v - begin], sum.edge_product);
    }
    for (std::size_t v = from; v < to; ++v)
        take(block.count[v - begin], static_cast<double>(part.counts()[v]));
}

/// Sums of the vertices from `begin` on, of all parts.
RELIEF_INLINE void load(const NormalSums& sums, std::size_t begin, std::size_t size,
                        BlockSums& block) {
    const auto set = [](double& to, double value) { to = value; };
    const auto add = [](double& to, double value) { to += value; };
    bool is_set = false;
    for (const PartialSums& part : sums.parts) {
        const std::size_t from = std::max<std::size_t>(begin, part.touched.lowest);
        const std::size_t to =
            std::min<std::size_t>(begin + size, std::size_t(part.touched.highest) + 1);
        if (from >= to) continue;
        const bool is_whole = to - from == at_once;
        if (!is_set && is_whole) {
            take_part(part, begin, from, to, block, set);
        } else {
            if (!is_set) block = {};
            take_part(part, begin, from, to, block, add);
        }
        is_set = true;
    }
    if (!is_set) block = {};
}

/// Sums of groups of vertices, as far as `size` groups go.
void load_shared(const NormalSums& sums, std::span<const std::uint32_t> first,
                 std::span<const std::uint32_t> members, std::size_t size, BlockSums& block) {
    block = {};
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = first[i]; k < first[i + 1]; ++k) {
            for (const PartialSums& part : sums.parts) {
                const NormalVoteSum& sum = part.sums()[members[k]];
                block.x[i] += sum.x;
                block.y[i] += sum.y;
                block.z[i] += sum.z;
                block.edge_product[i] += sum.edge_product;
                block.count[i] += part.counts()[members[k]];
            }
        }
    }
}

// A function of its own: inlined, GCC leaves its loop scalar.
RELIEF_TARGET_512 void round_block_512(const BlockSums& sums, BlockNormals& normals) {
    round_block(sums, normals);
}
RELIEF_TARGET_256 void round_block_256(const BlockSums& sums, BlockNormals& normals) {
    round_block(sums, normals);
}
[[gnu::noinline]] void round_block_any(const BlockSums& sums, BlockNormals& normals) {
    round_block(sums, normals);
}

/// Normals of a block of vertices; what is in doubt is left in `doubt`.
template <typename RoundBlock>
RELIEF_INLINE void round_vertices(const NormalSums& sums, std::size_t begin, std::size_t size,
                                  glm::vec3* normals, BlockNormals& rounded,
                                  const RoundBlock& round) {
    BlockSums block;
    load(sums, begin, size, block);
    round(block, rounded);
    for (std::size_t i = 0; i < size; ++i)
        normals[begin + i] = {rounded.x[i], rounded.y[i], rounded.z[i]};
}

RELIEF_TARGET_512 void round_vertices_512(const NormalSums& sums, std::size_t begin,
                                          std::size_t size, glm::vec3* normals,
                                          BlockNormals& rounded) {
    round_vertices(sums, begin, size, normals, rounded, round_block_512);
}
RELIEF_TARGET_256 void round_vertices_256(const NormalSums& sums, std::size_t begin,
                                          std::size_t size, glm::vec3* normals,
                                          BlockNormals& rounded) {
    round_vertices(sums, begin, size, normals, rounded, round_block_256);
}
void round_vertices_any(const NormalSums& sums, std::size_t begin, std::size_t size,
                        glm::vec3* normals, BlockNormals& rounded) {
    round_vertices(sums, begin, size, normals, rounded, round_block_any);
}

auto* best_round_vertices() {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return &round_vertices_512;
        case VectorTarget::wide:
            return &round_vertices_256;
        case VectorTarget::any:
            break;
    }
    return &round_vertices_any;
}

/// Indices gathered by several threads, sorted at the end.
class Gathered {
  public:
    void add(const BlockNormals& normals, std::size_t begin, std::size_t size) {
        std::uint32_t any = 0;
        for (std::size_t i = 0; i < size; ++i)
            any |= normals.doubt[i];
        if (any == 0) return;
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < size; ++i) {
            if (normals.doubt[i] != 0) indices_.push_back(static_cast<std::uint32_t>(begin + i));
        }
    }
    std::vector<std::uint32_t> sorted() {
        std::sort(indices_.begin(), indices_.end());
        return std::move(indices_);
    }

  private:
    std::mutex mutex_;
    std::vector<std::uint32_t> indices_;
};

constexpr std::size_t blocks_a_piece = 64;

/// Calls body(begin, size) for all blocks of `count` things.
template <typename Body>
void for_blocks(std::size_t count, const Body& body) {
    const std::size_t blocks = (count + at_once - 1) / at_once;
    parallel_for(blocks, blocks_a_piece, [&](std::size_t first, std::size_t end) {
        for (std::size_t b = first; b < end; ++b)
            body(b * at_once, std::min(at_once, count - b * at_once));
    });
}

}  // namespace

glm::vec3 on_grid(double x, double y, double z) {
    return {to_float(nearest(x * normal_grid)), to_float(nearest(y * normal_grid)),
            to_float(nearest(z * normal_grid))};
}

std::vector<std::uint32_t> round_normals(const NormalSums& sums, std::span<glm::vec3> normals) {
    Gathered doubtful;
    const auto round = best_round_vertices();
    for_blocks(normals.size(), [&](std::size_t begin, std::size_t size) {
        BlockNormals rounded;
        round(sums, begin, size, normals.data(), rounded);
        doubtful.add(rounded, begin, size);
    });
    return doubtful.sorted();
}

std::vector<std::uint32_t> round_shared_normals(const NormalSums& sums,
                                                std::span<const std::uint32_t> first,
                                                std::span<const std::uint32_t> members,
                                                std::span<glm::vec3> normals) {
    if (first.empty()) return {};
    Gathered doubtful;
    for_blocks(first.size() - 1, [&](std::size_t begin, std::size_t size) {
        BlockSums block;
        BlockNormals rounded;
        load_shared(sums, first.subspan(begin), members, size, block);
        round_block_any(block, rounded);
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t k = first[begin + i]; k < first[begin + i + 1]; ++k)
                normals[members[k]] = {rounded.x[i], rounded.y[i], rounded.z[i]};
        }
        doubtful.add(rounded, begin, size);
    });
    return doubtful.sorted();
}

}  // namespace relief
