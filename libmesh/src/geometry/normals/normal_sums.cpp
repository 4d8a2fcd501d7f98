// SPDX-License-Identifier: Apache-2.0
// Blocks of triangles: corners gathered into arrays, votes computed on whole vector registers, then
// added at the vertices. What limits this is memory: 24 bytes a triangle of indices and sums.
// Tests: tests/mesh/geometry/normals/normals_test.cpp.
#include "geometry/normals/normal_sums.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>

#include "geometry/check_triangles.h"
#include "geometry/direction.h"
#include "geometry/normals/normal_votes.h"
#include "large_memory.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/threads.h"
#include "vector_targets.h"

namespace relief {
namespace {

// The four doubles of a VoteSum as one operand; the compiler splits it where registers are smaller.
using Lanes = double __attribute__((vector_size(32), may_alias));

using Block = std::span<const glm::uvec3>;

/// One number of every triangle of a block.
template <typename T>
struct alignas(64) PerTriangle : std::array<T, triangles_at_once> {};

/// x, y and z of the first, second and third corner.
using BlockCorners = std::array<std::array<PerTriangle<float>, 3>, 3>;

/// Votes of a block of triangles; of no meaning where they are odd.
struct BlockVotes {
    PerTriangle<double> x, y, z, edge_product;
    std::array<PerTriangle<double>, 3> factor;
    PerTriangle<std::uint32_t> odd;  ///< 1 where not plainly sound, else 0.
};

/// What a run of triangles is summed into.
struct Job {
    std::span<const glm::vec3> positions;
    std::span<const glm::uvec3> triangles;
    std::uint32_t first_triangle;
    float scale;
    PartialSums* sums;
    VertexRange* ranges;
    std::vector<std::uint32_t>* odd;
    bool out_of_range = false;  ///< Some triangle names a vertex that does not exist.
};

RELIEF_INLINE VertexRange range_of(Block block) {
    std::uint32_t lowest = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t highest = 0;
    const std::uint32_t* index = &block[0].x;
    for (std::size_t i = 0; i < 3 * block.size(); ++i) {
        lowest = index[i] < lowest ? index[i] : lowest;
        highest = index[i] > highest ? index[i] : highest;
    }
    return {lowest, highest};
}

/// Corners one by one, for blocks that are not full or name the last vertex.
inline void gather_each(Block block, const glm::vec3* positions, BlockCorners& corners) {
    for (std::size_t i = 0; i < block.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3& position = positions[block[i][static_cast<int>(k)]];
            corners[k][0][i] = position.x;
            corners[k][1][i] = position.y;
            corners[k][2][i] = position.z;
        }
    }
}

/// Corners of a full block, four triangles at a time: each position is loaded whole, together with
/// the number behind it, which must exist.
RELIEF_INLINE void gather_four(Block block, const glm::vec3* positions, BlockCorners& corners) {
    using Floats = float __attribute__((vector_size(16)));
    for (std::size_t i = 0; i < triangles_at_once; i += 4) {
        for (std::size_t k = 0; k < 3; ++k) {
            Floats a, b, c, d;
            std::memcpy(&a, positions + block[i][static_cast<int>(k)], sizeof a);
            std::memcpy(&b, positions + block[i + 1][static_cast<int>(k)], sizeof b);
            std::memcpy(&c, positions + block[i + 2][static_cast<int>(k)], sizeof c);
            std::memcpy(&d, positions + block[i + 3][static_cast<int>(k)], sizeof d);
            const Floats xy_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
            const Floats xy_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
            const Floats z_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
            const Floats z_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
            const Floats x = __builtin_shufflevector(xy_ab, xy_cd, 0, 1, 4, 5);
            const Floats y = __builtin_shufflevector(xy_ab, xy_cd, 2, 3, 6, 7);
            const Floats z = __builtin_shufflevector(z_ab, z_cd, 0, 1, 4, 5);
            std::memcpy(&corners[k][0][i], &x, sizeof x);
            std::memcpy(&corners[k][1][i], &y, sizeof y);
            std::memcpy(&corners[k][2][i], &z, sizeof z);
        }
    }
}

template <NormalWeight weight, typename Real>
RELIEF_INLINE void vote(const BlockCorners& at, Real scale, BlockVotes& result) {
    using Point = std::array<float, 3>;
    for (std::size_t i = 0; i < triangles_at_once; ++i) {
        const TriangleVotes<Real> votes =
            triangle_votes<weight, Real>(Point{at[0][0][i], at[0][1][i], at[0][2][i]},
                                         Point{at[1][0][i], at[1][1][i], at[1][2][i]},
                                         Point{at[2][0][i], at[2][1][i], at[2][2][i]}, scale);
        result.odd[i] = votes.sound ? 0U : 1U;
        result.x[i] = static_cast<double>(votes.area_vector[0]);
        result.y[i] = static_cast<double>(votes.area_vector[1]);
        result.z[i] = static_cast<double>(votes.area_vector[2]);
        result.edge_product[i] = static_cast<double>(votes.edge_product);
        if constexpr (weight != NormalWeight::area) {
            result.factor[0][i] = static_cast<double>(votes.factor[0]);
            result.factor[1][i] = static_cast<double>(votes.factor[1]);
            result.factor[2][i] = static_cast<double>(votes.factor[2]);
        }
    }
}

RELIEF_INLINE void count_up(std::uint8_t& count) {
    count = static_cast<std::uint8_t>(count + (count != 255));
}

template <NormalWeight weight>
RELIEF_INLINE void scatter(Block block, const BlockVotes& votes, PartialSums& target) {
    auto* const sums = reinterpret_cast<Lanes*>(target.sums());
    std::uint8_t* const counts = target.counts();
    for (std::size_t i = 0; i < block.size(); ++i) {
        const Lanes vote = {votes.x[i], votes.y[i], votes.z[i], votes.edge_product[i]};
        const std::array<std::uint32_t, 3> at = {block[i].x, block[i].y, block[i].z};
        for (std::size_t k = 0; k < 3; ++k) {
            if constexpr (weight == NormalWeight::area)
                sums[at[k]] += vote;
            else
                sums[at[k]] += vote * votes.factor[k][i];
            count_up(counts[at[k]]);
        }
    }
}

RELIEF_INLINE bool any_odd(const BlockVotes& votes, std::size_t size) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < size; ++i)
        any |= votes.odd[i];
    return any != 0;
}

/// Notes the odd triangles of a block, and takes back the votes that they have been given.
inline void set_odd_aside(BlockVotes& votes, std::size_t first, std::size_t size,
                          std::vector<std::uint32_t>& odd) {
    for (std::size_t i = 0; i < size; ++i) {
        if (votes.odd[i] == 0) continue;
        odd.push_back(static_cast<std::uint32_t>(first + i));
        votes.x[i] = votes.y[i] = votes.z[i] = votes.edge_product[i] = 0.0;
        for (PerTriangle<double>& factor : votes.factor)
            factor[i] = 0.0;
    }
}

// Functions of their own: within the loop over blocks, GCC leaves the one over triangles scalar.
template <NormalWeight weight, typename Real>
RELIEF_TARGET_512 void vote_512(const BlockCorners& at, Real scale, BlockVotes& result) {
    vote<weight, Real>(at, scale, result);
}
template <NormalWeight weight, typename Real>
RELIEF_TARGET_256 void vote_256(const BlockCorners& at, Real scale, BlockVotes& result) {
    vote<weight, Real>(at, scale, result);
}
template <NormalWeight weight, typename Real>
[[gnu::noinline]] void vote_any(const BlockCorners& at, Real scale, BlockVotes& result) {
    vote<weight, Real>(at, scale, result);
}

template <NormalWeight weight, typename Real, typename Vote>
RELIEF_INLINE void add_votes(Job& job, const Vote& vote) {
    BlockCorners corners{};
    BlockVotes votes{};
    VertexRange touched{std::numeric_limits<std::uint32_t>::max(), 0};
    for (std::size_t first = 0; first < job.triangles.size(); first += triangles_at_once) {
        check_cancelled(first);
        const std::size_t size = std::min(triangles_at_once, job.triangles.size() - first);
        const Block block = job.triangles.subspan(first, size);
        const VertexRange range = range_of(block);
        if (range.highest >= job.positions.size()) {
            job.out_of_range = true;
            return;
        }
        job.ranges[first / triangles_at_once] = range;
        touched.lowest = std::min(touched.lowest, range.lowest);
        touched.highest = std::max(touched.highest, range.highest);

        if (size == triangles_at_once && range.highest + 1 < job.positions.size())
            gather_four(block, job.positions.data(), corners);
        else
            gather_each(block, job.positions.data(), corners);
        vote(corners, static_cast<Real>(job.scale), votes);
        if (any_odd(votes, size)) set_odd_aside(votes, job.first_triangle + first, size, *job.odd);
        scatter<weight>(block, votes, *job.sums);
    }
    job.sums->touched = touched;
}

template <NormalWeight weight, typename Real>
RELIEF_TARGET_512 void add_votes_512(Job& job) {
    add_votes<weight, Real>(job, vote_512<weight, Real>);
}
template <NormalWeight weight, typename Real>
RELIEF_TARGET_256 void add_votes_256(Job& job) {
    add_votes<weight, Real>(job, vote_256<weight, Real>);
}
template <NormalWeight weight, typename Real>
[[gnu::noinline]] void add_votes_any(Job& job) {
    add_votes<weight, Real>(job, vote_any<weight, Real>);
}

template <NormalWeight weight, typename Real>
void add_votes_here(Job& job) {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return add_votes_512<weight, Real>(job);
        case VectorTarget::wide:
            return add_votes_256<weight, Real>(job);
        case VectorTarget::any:
            return add_votes_any<weight, Real>(job);
    }
}

/// Votes of the triangles among the odd ones that are sound after all, in double.
void add_narrow(const Job& job, NormalWeight weight) {
    for (const std::uint32_t t : *job.odd) {
        const glm::uvec3& triangle = job.triangles[t - job.first_triangle];
        const std::array<glm::vec3, 3> at = {job.positions[triangle.x], job.positions[triangle.y],
                                             job.positions[triangle.z]};
        if (kind_of(at[0], at[1], at[2]) != TriangleKind::sound) continue;
        with_weight(weight, [&]<NormalWeight constant>() {
            const auto votes =
                triangle_votes<constant, double>(at[0], at[1], at[2], double(job.scale));
            for (int i = 0; i < 3; ++i) {
                const auto k = static_cast<std::size_t>(i);
                NormalVoteSum& sum = job.sums->sums()[triangle[i]];
                sum.x += votes.factor[k] * votes.area_vector[0];
                sum.y += votes.factor[k] * votes.area_vector[1];
                sum.z += votes.factor[k] * votes.area_vector[2];
                sum.edge_product += votes.factor[k] * votes.edge_product;
                count_up(job.sums->counts()[triangle[i]]);
            }
        });
    }
}

void run(Job& job, NormalWeight weight, Arithmetic arithmetic) {
    if (job.triangles.empty()) return;
    with_weight(weight, [&]<NormalWeight constant>() {
        if (arithmetic == Arithmetic::float32)
            add_votes_here<constant, float>(job);
        else
            add_votes_here<constant, double>(job);
    });
    if (!job.out_of_range) add_narrow(job, weight);
}

/// Twice the area along the normal; zero, and why, if the triangle is not sound.
std::pair<TriangleKind, glm::dvec3> area_vector_of(const glm::vec3& a, const glm::vec3& b,
                                                   const glm::vec3& c) {
    if (!is_finite(a) || !is_finite(b) || !is_finite(c))
        return {TriangleKind::non_finite, glm::dvec3(0.0)};
    // Beginning with the first by value: rounding depends on which two edges are crossed.
    std::array<glm::dvec3, 3> corners = {glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), comes_before),
                corners.end());
    const glm::dvec3 u = corners[1] - corners[0];
    const glm::dvec3 v = corners[2] - corners[0];
    const glm::dvec3 w = corners[2] - corners[1];
    const glm::dvec3 area_vector = glm::cross(u, v);
    const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)});
    if (glm::length(area_vector) > least_triangle_width * longest)
        return {TriangleKind::sound, area_vector};
    return {TriangleKind::degenerate, glm::dvec3(0.0)};
}

}  // namespace

TriangleKind kind_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return area_vector_of(a, b, c).first;
}

glm::vec3 triangle_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return rounded(direction_or_zero(area_vector_of(a, b, c).second));
}

std::vector<glm::vec3> normals_or_zero(std::span<const glm::vec3> positions,
                                       std::span<const glm::uvec3> triangles) {
    constexpr std::size_t grain = 4096;
    std::vector<glm::vec3> normals(triangles.size());
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            normals[t] = triangle_normal(positions[triangles[t].x], positions[triangles[t].y],
                                         positions[triangles[t].z]);
        }
    });
    return normals;
}

float scale_for(std::span<const glm::vec3> positions) {
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -lowest;
    for (const glm::vec3& position : positions) {
        for (int i = 0; i < 3; ++i) {
            if (!std::isfinite(position[i])) continue;
            lowest = std::min(lowest, position[i]);
            highest = std::max(highest, position[i]);
        }
    }
    const double size = double(highest) - double(lowest);
    if (!(size > 0.0)) return 1.0F;
    return std::ldexp(1.0F, std::clamp(-std::ilogb(size), -126, 127));
}

PartialSums::PartialSums(std::size_t vertex_count) {
    // Zeroed memory of large size comes from the system as it is needed: what no triangle touches
    // costs nothing.
    const std::size_t bytes = vertex_count * (sizeof(NormalVoteSum) + 1) + alignof(NormalVoteSum);
    memory_.reset(std::calloc(bytes, 1));
    if (!memory_) throw std::bad_alloc();
    void* begin = memory_.get();
    std::size_t room = bytes;
    sums_ = static_cast<NormalVoteSum*>(
        std::align(alignof(NormalVoteSum), vertex_count * sizeof(NormalVoteSum), begin, room));
    counts_ = reinterpret_cast<std::uint8_t*>(sums_ + vertex_count);
    expect_filling(sums_, vertex_count * sizeof(NormalVoteSum));
}

NormalSums sum_votes(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                     NormalWeight weight, Arithmetic arithmetic) {
    constexpr std::size_t worth_a_thread = 64 * triangles_at_once;
    // More parts than that would take more memory than their threads save time.
    constexpr std::size_t most_parts = 8;
    const std::size_t blocks = (triangles.size() + triangles_at_once - 1) / triangles_at_once;
    const std::size_t parts = std::clamp<std::size_t>(
        std::min<std::size_t>(thread_count(), triangles.size() / worth_a_thread), 1, most_parts);

    NormalSums result;
    result.ranges.resize(blocks);
    std::vector<std::vector<std::uint32_t>> odd(parts);
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < parts; ++i)
        result.parts.emplace_back(positions.size());
    const float scale = arithmetic == Arithmetic::float32 ? scale_for(positions) : 1.0F;
    for (std::size_t i = 0; i < parts; ++i) {
        const std::size_t first = blocks * i / parts;
        const std::size_t begin = first * triangles_at_once;
        const std::size_t end =
            std::min(blocks * (i + 1) / parts * triangles_at_once, triangles.size());
        jobs.push_back({positions, triangles.subspan(begin, end - begin),
                        static_cast<std::uint32_t>(begin), scale, &result.parts[i],
                        result.ranges.data() + first, &odd[i]});
    }
    parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            run(jobs[i], weight, arithmetic);
    });
    for (const Job& job : jobs) {
        if (job.out_of_range) check_triangles(triangles, positions.size());
    }
    for (const std::vector<std::uint32_t>& some : odd)
        result.odd.insert(result.odd.end(), some.begin(), some.end());
    return result;
}

}  // namespace relief
