// SPDX-License-Identifier: Apache-2.0
// Sums the weighted normals of all triangles at their vertices, and rounds the sums.
//
// Triangles are processed in blocks: corners are gathered into arrays, contributions are computed
// on whole vector registers and then added at the vertices. The limit is memory: 24 bytes of
// indices and sums per triangle.
//
// Derivation of the error bound, in units u = 2^-53 of relative rounding: edges have an error of u,
// so an area vector has an error of less than 8 u times the largest product of two edges. The error
// of a factor (normal_contributions.h) changes the contribution by less than 24 u times the factor
// times that product. Adding n contributions in any order changes the sum by n u times the sum of
// their lengths. A unit vector has the sum's error divided by its length, plus 4 u from
// normalizing. The code allows twice that. Contributions computed in float count as exact: only
// their addition rounds.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <mutex>

#include "geometry/check_triangles.h"
#include "geometry/direction.h"
#include "geometry/normal_contributions.h"
#include "geometry/normal_sums.h"
#include "parallel.h"
#include "portable_math.h"
#include "progress_stage.h"
#include "relief/mesh/execution.h"

namespace relief::detail {
namespace {

using Block = std::span<const glm::uvec3>;

// The four doubles of a sum as one operand.
using Lanes [[gnu::may_alias]] = Vector<double, 32>;

// Rounding.

constexpr std::size_t at_once = 128;  // Vertices.
constexpr double unit_rounding = 0x1p-53;

struct BlockSums {
    alignas(64) std::array<double, at_once> x, y, z, edge_product, count;
};

struct BlockNormals {
    alignas(64) std::array<float, at_once> x, y, z;
    alignas(64) std::array<std::uint32_t, at_once> doubt;  ///< 1 or 0.
};

/// Rounds to the nearest integer, for |value| < 2^51.
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
        // The condition is true for NaN (from a sum of zero) and for a saturated count.
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
    std::size_t v = from;
    for (; v + 4 <= to; v += 4) {
        const auto* const sums = reinterpret_cast<const Lanes*>(part.sums() + v);
        FourDoubles x = sums[0], y = sums[1], z = sums[2], edge_product = sums[3];
        transpose(x, y, z, edge_product);
        take(block.x[v - begin], x);
        take(block.y[v - begin], y);
        take(block.z[v - begin], z);
        take(block.edge_product[v - begin], edge_product);
    }
    for (; v < to; ++v) {
        const WeightedNormalSum& sum = part.sums()[v];
        take(block.x[v - begin], sum.x);
        take(block.y[v - begin], sum.y);
        take(block.z[v - begin], sum.z);
        take(block.edge_product[v - begin], sum.edge_product);
    }
    for (v = from; v < to; ++v)
        take(block.count[v - begin], static_cast<double>(part.counts()[v]));
}

/// Adds the sums of all parts for the vertices from `begin`.
RELIEF_INLINE void load(std::span<const PartialSums> parts, std::size_t begin, std::size_t size,
                        BlockSums& block) {
    const auto set = [](double& to, const auto& values) {
        std::memcpy(&to, &values, sizeof values);
    };
    const auto add = [](double& to, const auto& values) {
        std::remove_cvref_t<decltype(values)> sum;
        std::memcpy(&sum, &to, sizeof sum);
        sum += values;
        std::memcpy(&to, &sum, sizeof sum);
    };
    bool is_set = false;
    for (const PartialSums& part : parts) {
        const std::size_t from = std::max<std::size_t>(begin, part.vertices().lowest);
        const std::size_t to =
            std::min<std::size_t>(begin + size, std::size_t(part.vertices().highest) + 1);
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

// A separate function: GCC does not vectorize the loop when it is inlined.
RELIEF_TARGET_512 void round_block_512(const BlockSums& sums, BlockNormals& normals) {
    round_block(sums, normals);
}
RELIEF_TARGET_256 void round_block_256(const BlockSums& sums, BlockNormals& normals) {
    round_block(sums, normals);
}
[[gnu::noinline]] void round_block_any(const BlockSums& sums, BlockNormals& normals) {
    round_block(sums, normals);
}

/// Rounds the normals of a block of vertices and marks uncertain ones in `doubt`.
template <typename RoundBlock>
RELIEF_INLINE void round_vertices(std::span<const PartialSums> parts, std::size_t begin,
                                  std::size_t size, StridedSpan<glm::vec3> normals,
                                  BlockNormals& rounded, const RoundBlock& round) {
    BlockSums block;
    load(parts, begin, size, block);
    round(block, rounded);
    for (std::size_t i = 0; i < size; ++i)
        normals[begin + i] = {rounded.x[i], rounded.y[i], rounded.z[i]};
}

RELIEF_TARGET_512 void round_vertices_512(std::span<const PartialSums> parts, std::size_t begin,
                                          std::size_t size, StridedSpan<glm::vec3> normals,
                                          BlockNormals& rounded) {
    round_vertices(parts, begin, size, normals, rounded, round_block_512);
}
RELIEF_TARGET_256 void round_vertices_256(std::span<const PartialSums> parts, std::size_t begin,
                                          std::size_t size, StridedSpan<glm::vec3> normals,
                                          BlockNormals& rounded) {
    round_vertices(parts, begin, size, normals, rounded, round_block_256);
}
void round_vertices_any(std::span<const PartialSums> parts, std::size_t begin, std::size_t size,
                        StridedSpan<glm::vec3> normals, BlockNormals& rounded) {
    round_vertices(parts, begin, size, normals, rounded, round_block_any);
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

/// Adds the doubtful vertices of a block.
void gather_doubtful(const BlockNormals& normals, std::size_t begin, std::size_t size,
                     std::vector<std::uint32_t>& indices) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < size; ++i)
        any |= normals.doubt[i];
    if (any == 0) return;
    for (std::size_t i = 0; i < size; ++i) {
        if (normals.doubt[i] != 0) indices.push_back(static_cast<std::uint32_t>(begin + i));
    }
}

/// Rounds the normals of vertices that probably get no more contributions, while their sums are in
/// the cache: those below all vertices of the last blocks of triangles. Vertices that do get
/// another contribution are rounded again at the end.
class EarlyNormals {
  public:
    /// \param claimed  one value for each block of vertices, shared by all parts: the first part
    /// that rounds a block sets it, so that no two threads write one normal.
    EarlyNormals(PartialSums& sums, StridedSpan<glm::vec3> normals,
                 std::span<std::atomic<bool>> claimed)
        : sums_(sums), normals_(normals), claimed_(claimed) {}

    /// \param range  the vertices of a block of triangles, which were added to the sums
    void add(std::span<const glm::uvec3> triangles, const VertexRange& range) {
        if (range.lowest < end_) {
            for (const glm::uvec3& triangle : triangles) {
                for (int i = 0; i < 3; ++i)
                    sums_.rounded()[triangle[i] / at_once] = 0;
            }
        }
        lowest_ = std::min(lowest_, range.lowest);
        if (++blocks_ % 16 != 0) return;
        round_up_to(std::min(lowest_, lowest_before_));
        lowest_before_ = std::exchange(lowest_, std::numeric_limits<std::uint32_t>::max());
    }
    [[nodiscard]] const std::vector<std::uint32_t>& doubtful() const { return doubtful_; }

  private:
    void round_up_to(std::size_t end) {
        const auto round = best_round_vertices();
        const std::size_t first = (sums_.vertices().lowest + at_once - 1) / at_once * at_once;
        for (end_ = std::max(end_, first); end_ + at_once <= end; end_ += at_once) {
            if (claimed_[end_ / at_once].exchange(true, std::memory_order_relaxed)) continue;
            BlockNormals rounded;
            round({&sums_, 1}, end_, at_once, normals_, rounded);
            gather_doubtful(rounded, end_, at_once, doubtful_);
            sums_.rounded()[end_ / at_once] = 1;
        }
    }

    PartialSums& sums_;
    StridedSpan<glm::vec3> normals_;
    std::span<std::atomic<bool>> claimed_;
    std::size_t end_ = 0;
    std::size_t blocks_ = 0;
    std::uint32_t lowest_ = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t lowest_before_ = 0;
    std::vector<std::uint32_t> doubtful_;
};

// Summation.

/// One value per triangle of a block.
template <typename T>
struct alignas(64) PerTriangle : std::array<T, triangles_at_once> {};

/// x, y and z of the first, second and third corner.
using BlockCorners = std::array<std::array<PerTriangle<float>, 3>, 3>;

/// Contributions of a block of triangles; undefined for odd ones.
struct BlockContributions {
    PerTriangle<double> x, y, z, edge_product;
    std::array<PerTriangle<double>, 3> factor;
    PerTriangle<std::uint32_t> odd;  ///< 1 if the triangle is not clearly valid.
};

/// Output of the summation of a range of triangles.
struct Job {
    StridedSpan<const glm::vec3> positions;
    TriangleSpan triangles;
    std::uint32_t first_triangle;
    float scale;
    PartialSums* sums;
    VertexRange* ranges;
    std::vector<std::uint32_t>* odd;
    EarlyNormals normals;
    bool out_of_range = false;  ///< A triangle refers to a vertex that does not exist.
};

/// Loads corners one by one, for blocks that are not full or that use the last vertex.
inline void gather_each(Block block, StridedSpan<const glm::vec3> positions,
                        BlockCorners& corners) {
    for (std::size_t i = 0; i < block.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3& position = positions[block[i][static_cast<int>(k)]];
            corners[k][0][i] = position.x;
            corners[k][1][i] = position.y;
            corners[k][2][i] = position.z;
        }
    }
}

/// Loads the corners of a full block.
RELIEF_INLINE void gather_all(Block block, StridedSpan<const glm::vec3> positions,
                              BlockCorners& corners) {
    for (std::size_t i = 0; i < triangles_at_once; i += 4) {
        for (int k = 0; k < 3; ++k) {
            auto& corner = corners[static_cast<std::size_t>(k)];
            gather_four(positions, &block[i], k, &corner[0][i], &corner[1][i], &corner[2][i]);
        }
    }
}

template <NormalWeight weight, typename Real>
RELIEF_INLINE void contribution(const BlockCorners& at, Real scale, BlockContributions& result) {
    using Point = std::array<float, 3>;
    for (std::size_t i = 0; i < triangles_at_once; ++i) {
        const TriangleContributions<Real> contributions = triangle_contributions<weight, Real>(
            Point{at[0][0][i], at[0][1][i], at[0][2][i]},
            Point{at[1][0][i], at[1][1][i], at[1][2][i]},
            Point{at[2][0][i], at[2][1][i], at[2][2][i]}, scale);
        result.odd[i] = contributions.sound ? 0U : 1U;
        result.x[i] = static_cast<double>(contributions.area_vector[0]);
        result.y[i] = static_cast<double>(contributions.area_vector[1]);
        result.z[i] = static_cast<double>(contributions.area_vector[2]);
        result.edge_product[i] = static_cast<double>(contributions.edge_product);
        if constexpr (weight != NormalWeight::area) {
            result.factor[0][i] = static_cast<double>(contributions.factor[0]);
            result.factor[1][i] = static_cast<double>(contributions.factor[1]);
            result.factor[2][i] = static_cast<double>(contributions.factor[2]);
        }
    }
}

RELIEF_INLINE void count_up(std::uint8_t& count) {
    // This is faster than a choice, because the branch is never taken.
    if (++count == 0) [[unlikely]]
        count = 255;
}

/// Adds the contribution of one triangle at its vertices.
template <NormalWeight weight>
RELIEF_INLINE void scatter(const glm::uvec3& triangle, const FourDoubles& contribution,
                           const BlockContributions& contributions, std::size_t i, Lanes* sums,
                           std::uint8_t* counts) {
    const std::array<std::uint32_t, 3> at = {triangle.x, triangle.y, triangle.z};
    for (std::size_t k = 0; k < 3; ++k) {
        if constexpr (weight == NormalWeight::area)
            sums[at[k]] += contribution;
        else
            sums[at[k]] += contribution * contributions.factor[k][i];
        count_up(counts[at[k]]);
    }
}

template <NormalWeight weight>
RELIEF_INLINE void scatter(Block block, const BlockContributions& contributions,
                           PartialSums& target) {
    auto* const sums = reinterpret_cast<Lanes*>(target.sums());
    std::uint8_t* const counts = target.counts();
    std::size_t i = 0;
    for (; i + 4 <= block.size(); i += 4) {
        FourDoubles a, b, c, d;
        std::memcpy(&a, &contributions.x[i], sizeof a);
        std::memcpy(&b, &contributions.y[i], sizeof b);
        std::memcpy(&c, &contributions.z[i], sizeof c);
        std::memcpy(&d, &contributions.edge_product[i], sizeof d);
        transpose(a, b, c, d);
        scatter<weight>(block[i], a, contributions, i, sums, counts);
        scatter<weight>(block[i + 1], b, contributions, i + 1, sums, counts);
        scatter<weight>(block[i + 2], c, contributions, i + 2, sums, counts);
        scatter<weight>(block[i + 3], d, contributions, i + 3, sums, counts);
    }
    for (; i < block.size(); ++i) {
        const FourDoubles contribution = {contributions.x[i], contributions.y[i],
                                          contributions.z[i], contributions.edge_product[i]};
        scatter<weight>(block[i], contribution, contributions, i, sums, counts);
    }
}

RELIEF_INLINE bool any_odd(const BlockContributions& contributions, std::size_t size) {
    std::uint32_t any = 0;
    for (std::size_t i = 0; i < size; ++i)
        any |= contributions.odd[i];
    return any != 0;
}

/// Records the odd triangles of a block and removes their contributions.
inline void set_odd_aside(BlockContributions& contributions, std::size_t first, std::size_t size,
                          std::vector<std::uint32_t>& odd) {
    for (std::size_t i = 0; i < size; ++i) {
        if (contributions.odd[i] == 0) continue;
        odd.push_back(static_cast<std::uint32_t>(first + i));
        contributions.x[i] = contributions.y[i] = contributions.z[i] =
            contributions.edge_product[i] = 0.0;
        for (PerTriangle<double>& factor : contributions.factor)
            factor[i] = 0.0;
    }
}

// Separate functions: inside the loop over blocks, GCC does not vectorize the loop over triangles.
template <NormalWeight weight, typename Real>
RELIEF_TARGET_512 void contribution_512(const BlockCorners& at, Real scale,
                                        BlockContributions& result) {
    contribution<weight, Real>(at, scale, result);
}
template <NormalWeight weight, typename Real>
RELIEF_TARGET_256 void contribution_256(const BlockCorners& at, Real scale,
                                        BlockContributions& result) {
    contribution<weight, Real>(at, scale, result);
}
template <NormalWeight weight, typename Real>
[[gnu::noinline]] void contribution_any(const BlockCorners& at, Real scale,
                                        BlockContributions& result) {
    contribution<weight, Real>(at, scale, result);
}

template <NormalWeight weight, typename Real, typename Contribution>
RELIEF_INLINE void add_contributions(Job& job, const Contribution& contribution) {
    BlockCorners corners{};
    BlockContributions contributions{};
    std::array<glm::uvec3, triangles_at_once> wide;
    for (std::size_t first = 0; first < job.triangles.size(); first += triangles_at_once) {
        check_cancelled(first);
        const std::size_t size = std::min(triangles_at_once, job.triangles.size() - first);
        const Block block = block_of(job.triangles, first, size, wide);
        const VertexRange range = range_of(block);
        if (range.highest >= job.positions.size()) {
            job.out_of_range = true;
            return;
        }
        job.ranges[first / triangles_at_once] = range;
        job.sums->extend_to(range);
        if (size == triangles_at_once && range.highest + 1 < job.positions.size())
            gather_all(block, job.positions, corners);
        else
            gather_each(block, job.positions, corners);
        contribution(corners, static_cast<Real>(job.scale), contributions);
        if (any_odd(contributions, size))
            set_odd_aside(contributions, job.first_triangle + first, size, *job.odd);
        scatter<weight>(block, contributions, *job.sums);
        job.normals.add(block, range);
    }
}

template <NormalWeight weight, typename Real>
RELIEF_TARGET_512 void add_contributions_512(Job& job) {
    add_contributions<weight, Real>(job, contribution_512<weight, Real>);
}
template <NormalWeight weight, typename Real>
RELIEF_TARGET_256 void add_contributions_256(Job& job) {
    add_contributions<weight, Real>(job, contribution_256<weight, Real>);
}
template <NormalWeight weight, typename Real>
[[gnu::noinline]] void add_contributions_any(Job& job) {
    add_contributions<weight, Real>(job, contribution_any<weight, Real>);
}

template <NormalWeight weight, typename Real>
void add_contributions_here(Job& job) {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            return add_contributions_512<weight, Real>(job);
        case VectorTarget::wide:
            return add_contributions_256<weight, Real>(job);
        case VectorTarget::any:
            return add_contributions_any<weight, Real>(job);
    }
}

/// Adds the contributions of the odd triangles that are valid, in double precision.
void add_narrow(const Job& job, NormalWeight weight) {
    for (const std::uint32_t t : *job.odd) {
        const glm::uvec3& triangle = job.triangles[t - job.first_triangle];
        const std::array<glm::vec3, 3> at = {job.positions[triangle.x], job.positions[triangle.y],
                                             job.positions[triangle.z]};
        if (kind_of(at[0], at[1], at[2]) != TriangleKind::sound) continue;
        with_weight(weight, [&]<NormalWeight constant>() {
            const auto contributions =
                triangle_contributions<constant, double>(at[0], at[1], at[2], double(job.scale));
            for (int i = 0; i < 3; ++i) {
                const auto k = static_cast<std::size_t>(i);
                WeightedNormalSum& sum = job.sums->sums()[triangle[i]];
                sum.x += contributions.factor[k] * contributions.area_vector[0];
                sum.y += contributions.factor[k] * contributions.area_vector[1];
                sum.z += contributions.factor[k] * contributions.area_vector[2];
                sum.edge_product += contributions.factor[k] * contributions.edge_product;
                count_up(job.sums->counts()[triangle[i]]);
                job.sums->rounded()[triangle[i] / at_once] = 0;
            }
        });
    }
}

void run(Job& job, NormalWeight weight, Arithmetic arithmetic) {
    if (job.triangles.empty()) return;
    with_weight(weight, [&]<NormalWeight constant>() {
        if (arithmetic == Arithmetic::float32)
            add_contributions_here<constant, float>(job);
        else
            add_contributions_here<constant, double>(job);
    });
    if (!job.out_of_range) add_narrow(job, weight);
}

/// Area vector (twice the area along the normal), or zero and the reason if the triangle is not
/// valid.
std::pair<TriangleKind, glm::dvec3> area_vector_of(const glm::vec3& a, const glm::vec3& b,
                                                   const glm::vec3& c) {
    if (!is_finite(a) || !is_finite(b) || !is_finite(c))
        return {TriangleKind::non_finite, glm::dvec3(0.0)};
    // Starts with the smallest corner by value, because rounding depends on which two edges are
    // multiplied.
    std::array<glm::dvec3, 3> corners = {glm::dvec3(a), glm::dvec3(b), glm::dvec3(c)};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), comes_before),
                corners.end());
    const glm::dvec3 u = corners[1] - corners[0];
    const glm::dvec3 v = corners[2] - corners[0];
    const glm::dvec3 w = corners[2] - corners[1];
    const glm::dvec3 area_vector = glm::cross(u, v);
    const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)});
    if (glm::length(area_vector) > min_triangle_width * longest)
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

std::vector<glm::vec3> normals_or_zero(StridedSpan<const glm::vec3> positions,
                                       TriangleSpan triangles) {
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

float scale_for(StridedSpan<const glm::vec3> positions) {
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -lowest;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const glm::vec3& position = positions[v];
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

void PartialSums::clear(std::size_t begin, std::size_t end) {
    std::fill(sums() + begin, sums() + end, WeightedNormalSum{});
    std::fill(counts() + begin, counts() + end, std::uint8_t{0});
}

PartialSums::PartialSums(std::size_t vertex_count)
    : sums_(vertex_count),
      counts_(vertex_count),
      rounded_((vertex_count + at_once - 1) / at_once, std::uint8_t{0}) {}

void PartialSums::extend_to(const VertexRange& range) {
    if (vertices_.lowest > vertices_.highest) {
        clear(range.lowest, std::size_t(range.highest) + 1);
        vertices_ = range;
        return;
    }
    if (range.lowest < vertices_.lowest) {
        clear(range.lowest, vertices_.lowest);
        vertices_.lowest = range.lowest;
    }
    if (range.highest > vertices_.highest) {
        clear(std::size_t(vertices_.highest) + 1, std::size_t(range.highest) + 1);
        vertices_.highest = range.highest;
    }
}

NormalSums sum_contributions(StridedSpan<const glm::vec3> positions, TriangleSpan triangles,
                             NormalWeight weight, Arithmetic arithmetic,
                             StridedSpan<glm::vec3> normals) {
    constexpr std::size_t worth_a_thread = 64 * triangles_at_once;
    // A larger number of parts would cost more memory than the threads save time.
    constexpr std::size_t max_parts = 8;
    const std::size_t blocks = (triangles.size() + triangles_at_once - 1) / triangles_at_once;
    const std::size_t parts = std::clamp<std::size_t>(
        std::min<std::size_t>(thread_count(), triangles.size() / worth_a_thread), 1, max_parts);

    NormalSums result;
    result.ranges.resize(blocks);
    std::vector<std::vector<std::uint32_t>> odd(parts);
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < parts; ++i)
        result.parts.emplace_back(positions.size());
    std::vector<std::atomic<bool>> claimed((positions.size() + at_once - 1) / at_once);
    const float scale = arithmetic == Arithmetic::float32 ? scale_for(positions) : 1.0F;
    for (std::size_t i = 0; i < parts; ++i) {
        const std::size_t first = blocks * i / parts;
        const std::size_t begin = first * triangles_at_once;
        const std::size_t end =
            std::min(blocks * (i + 1) / parts * triangles_at_once, triangles.size());
        jobs.push_back({positions, triangles.subspan(begin, end - begin),
                        static_cast<std::uint32_t>(begin), scale, &result.parts[i],
                        result.ranges.data() + first, &odd[i],
                        EarlyNormals(result.parts[i], normals, claimed)});
    }
    parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            run(jobs[i], weight, arithmetic);
    });
    for (const Job& job : jobs) {
        if (job.out_of_range) check_triangles(triangles, positions.size());
        result.doubtful.insert(result.doubtful.end(), job.normals.doubtful().begin(),
                               job.normals.doubtful().end());
    }
    for (const std::vector<std::uint32_t>& some : odd)
        result.odd.insert(result.odd.end(), some.begin(), some.end());
    return result;
}

namespace {

/// Adds the sums of `size` groups of vertices.
void load_shared(const NormalSums& sums, std::span<const std::uint32_t> first,
                 std::span<const std::uint32_t> members, std::size_t size, BlockSums& block) {
    block = {};
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = first[i]; k < first[i + 1]; ++k) {
            for (const PartialSums& part : sums.parts) {
                const auto& [lowest, highest] = part.vertices();
                if (members[k] < lowest || members[k] > highest) continue;
                const WeightedNormalSum& sum = part.sums()[members[k]];
                block.x[i] += sum.x;
                block.y[i] += sum.y;
                block.z[i] += sum.z;
                block.edge_product[i] += sum.edge_product;
                block.count[i] += part.counts()[members[k]];
            }
        }
    }
}

/// Indices gathered by several threads, sorted at the end.
class Gathered {
  public:
    void add(const BlockNormals& normals, std::size_t begin, std::size_t size) {
        std::vector<std::uint32_t> some;
        gather_doubtful(normals, begin, size, some);
        add(some);
    }
    void add(std::span<const std::uint32_t> some) {
        if (some.empty()) return;
        const std::lock_guard lock(mutex_);
        indices_.insert(indices_.end(), some.begin(), some.end());
    }
    /// Each index once.
    std::vector<std::uint32_t> sorted() {
        std::sort(indices_.begin(), indices_.end());
        indices_.erase(std::unique(indices_.begin(), indices_.end()), indices_.end());
        return std::move(indices_);
    }

  private:
    std::mutex mutex_;
    std::vector<std::uint32_t> indices_;
};

/// Tests whether the only part with sums of a block of vertices has rounded it.
bool is_rounded(std::span<const PartialSums> parts, std::size_t begin) {
    std::size_t with_sums = 0;
    bool rounded = false;
    for (const PartialSums& part : parts) {
        const auto& [lowest, highest] = part.vertices();
        if (lowest > highest || lowest >= begin + at_once || highest < begin) continue;
        ++with_sums;
        rounded = part.rounded()[begin / at_once] != 0;
    }
    return with_sums == 1 && rounded;
}

constexpr std::size_t blocks_a_piece = 64;

/// Calls body(begin, size) for all blocks of `count` elements.
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

std::vector<std::uint32_t> round_normals(const NormalSums& sums, StridedSpan<glm::vec3> normals) {
    Gathered doubtful;
    doubtful.add(sums.doubtful);
    const auto round = best_round_vertices();
    for_blocks(normals.size(), [&](std::size_t begin, std::size_t size) {
        if (is_rounded(sums.parts, begin)) return;
        BlockNormals rounded;
        round(sums.parts, begin, size, normals, rounded);
        doubtful.add(rounded, begin, size);
    });
    return doubtful.sorted();
}

std::vector<std::uint32_t> round_shared_normals(const NormalSums& sums,
                                                std::span<const std::uint32_t> first,
                                                std::span<const std::uint32_t> members,
                                                StridedSpan<glm::vec3> normals) {
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

}  // namespace relief::detail
