// SPDX-License-Identifier: Apache-2.0
// Blocks of triangles: corners gathered into arrays, votes computed on whole vector registers.
// Triangles that are not ordinary (no gradient, a value that is not finite, a normal or an edge
// without direction, numbers at the ends of float's range) are then done again, one by one.
// Tests: tests/mesh/geometry/tangents/tangent_votes_test.cpp.
#include "geometry/tangents/tangent_vote_blocks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>

#include "geometry/corner_angle.h"
#include "parallel.h"
#include "vector_targets.h"

namespace relief {
namespace {

constexpr std::size_t triangles_at_once = 64;

/// One number of every triangle of a block.
template <typename T>
struct alignas(64) PerTriangle : std::array<T, triangles_at_once> {};

template <typename T, std::size_t N>
using Vectors = std::array<PerTriangle<T>, N>;

/// Corners of a block, in upright images.
struct BlockCorners {
    std::array<Vectors<float, 3>, 3> position;
    std::array<Vectors<float, 3>, 3> normal;
    std::array<Vectors<float, 2>, 3> texcoord;
};

/// How the texture lies on the triangles of a block.
struct BlockAxes {
    Vectors<float, 3> u;             ///< Along growing u.
    Vectors<float, 3> v;             ///< Along growing v up.
    PerTriangle<double> length;      ///< Of the true gradient along u, over the length of `u`.
    PerTriangle<float> side;         ///< 1 or, mirrored, -1.
    PerTriangle<std::uint32_t> odd;  ///< 1 where the rest may mean nothing, else 0.
};

/// Votes at one corner of every triangle of a block.
struct BlockVotes {
    Vectors<std::int32_t, 3> vector;
    PerTriangle<std::int32_t> exponent;
    PerTriangle<std::int32_t> seen;
    PerTriangle<std::uint32_t> odd;
};

void gather(const TangentInput& input, std::size_t first, std::size_t count, BlockCorners& block) {
    for (std::size_t i = 0; i < count; ++i) {
        const glm::uvec3& triangle = input.triangles[first + i];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = triangle[static_cast<int>(k)];
            const glm::vec3& position = input.positions[vertex];
            block.position[k][0][i] = position.x;
            block.position[k][1][i] = position.y;
            block.position[k][2][i] = position.z;
            const glm::vec3& normal = input.normals[vertex];
            block.normal[k][0][i] = normal.x;
            block.normal[k][1][i] = normal.y;
            block.normal[k][2][i] = normal.z;
            const glm::vec2& texcoord = input.texcoords[vertex];
            block.texcoord[k][0][i] = texcoord.x;
            block.texcoord[k][1][i] = -texcoord.y;
        }
    }
}

// Of a float: its exponent, and what makes 2^(254 - exponent) of that.
constexpr std::uint32_t float_exponent = 0x7f800000U;
constexpr std::uint32_t float_turned = 254U << 23;

/// The largest of three numbers without their signs.
RELIEF_INLINE float largest_of(float a, float b, float c) {
    return std::max(std::max(std::abs(a), std::abs(b)), std::abs(c));
}

RELIEF_INLINE void find_axes(const BlockCorners& block, BlockAxes& __restrict axes) {
    const auto& p = block.position;
    const auto& t = block.texcoord;
    for (std::size_t i = 0; i < triangles_at_once; ++i) {
        const float ax = p[1][0][i] - p[0][0][i], bx = p[2][0][i] - p[0][0][i];
        const float ay = p[1][1][i] - p[0][1][i], by = p[2][1][i] - p[0][1][i];
        const float az = p[1][2][i] - p[0][2][i], bz = p[2][2][i] - p[0][2][i];
        const float cx = p[2][0][i] - p[1][0][i];
        const float cy = p[2][1][i] - p[1][1][i];
        const float cz = p[2][2][i] - p[1][2][i];
        const float su = t[1][0][i] - t[0][0][i], tu = t[2][0][i] - t[0][0][i];
        const float sv = t[1][1][i] - t[0][1][i], tv = t[2][1][i] - t[0][1][i];
        // Not a number stays one through a sum, but not through a maximum.
        const float sum = std::abs(ax) + std::abs(ay) + std::abs(az) + std::abs(bx) + std::abs(by) +
                          std::abs(bz) + std::abs(su) + std::abs(sv) + std::abs(tu) + std::abs(tv);
        const float first = largest_of(ax, ay, az);
        const float second = largest_of(bx, by, bz);
        const float third = largest_of(cx, cy, cz);
        const float size = std::max(first, second);
        const float image_size = std::max(largest_of(su, sv, tu), std::abs(tv));
        const std::uint32_t exponent = std::bit_cast<std::uint32_t>(size) & float_exponent;
        const std::uint32_t image_exponent =
            std::bit_cast<std::uint32_t>(image_size) & float_exponent;
        const float scale = std::bit_cast<float>(float_turned - exponent);
        const float image_scale = std::bit_cast<float>(float_turned - image_exponent);
        const TextureAxes found = texture_axes(
            {ax * scale, ay * scale, az * scale}, {bx * scale, by * scale, bz * scale},
            {su * image_scale, sv * image_scale}, {tu * image_scale, tv * image_scale});
        const float sign = std::copysign(1.0F, found.area);
        axes.u[0][i] = sign * found.u[0];
        axes.u[1][i] = sign * found.u[1];
        axes.u[2][i] = sign * found.u[2];
        axes.v[0][i] = sign * found.v[0];
        axes.v[1][i] = sign * found.v[1];
        axes.v[2][i] = sign * found.v[2];
        const float u_size = largest_of(found.u[0], found.u[1], found.u[2]);
        const float v_size = largest_of(found.v[0], found.v[1], found.v[2]);
        // Gradient = axis / area; edges are the true ones times their scales.
        axes.length[i] = double(image_scale) / (double(scale) * std::abs(double(found.area)));
        axes.side[i] = sign;
        const float least = std::min(std::min(std::min(first, second), third),
                                     std::min(std::min(u_size, v_size), std::abs(found.area)));
        const std::uint32_t narrow = least > 0.0F ? 0U : 1U;
        const std::uint32_t small = std::min(size, image_size) > 1e-37F ? 0U : 1U;
        const std::uint32_t large = sum < 1e37F ? 0U : 1U;
        axes.odd[i] = narrow | small | large;
    }
}

// Of a double: its exponent, and what makes 2^(vote_bits - 1 - exponent) of that.
constexpr std::uint64_t double_exponent = 0x7ff0000000000000ULL;
constexpr std::uint64_t double_turned = std::uint64_t(2046 + vote_bits - 1) << 52;

/// Cut to what a vote can hold; what is not a number, in triangles that are odd, becomes one.
RELIEF_INLINE std::int32_t to_vote_bits(double number) {
    constexpr double limit = 1 << vote_bits;
    return static_cast<std::int32_t>(std::min(std::max(-limit, number), limit));
}

template <TangentWeight weight, std::size_t corner>
RELIEF_INLINE void vote_at_corner(const BlockCorners& block, const BlockAxes& axes,
                                  BlockVotes& votes) {
    const auto& here = block.position[corner];
    const auto& next = block.position[(corner + 1) % 3];
    const auto& previous = block.position[(corner + 2) % 3];
    const auto& normal = block.normal[corner];
    for (std::size_t i = 0; i < triangles_at_once; ++i) {
        const double nx = normal[0][i], ny = normal[1][i], nz = normal[2][i];
        const double nn = nx * nx + ny * ny + nz * nz;
        const double per_nn = 1.0 / nn;
        const double ux = axes.u[0][i], uy = axes.u[1][i], uz = axes.u[2][i];
        const double vx = axes.v[0][i], vy = axes.v[1][i], vz = axes.v[2][i];
        const double un = (ux * nx + uy * ny + uz * nz) * per_nn;
        const double vn = (vx * nx + vy * ny + vz * nz) * per_nn;
        // In the plane of the normal.
        const double px = ux - un * nx, py = uy - un * ny, pz = uz - un * nz;
        const double qx = vx - vn * nx, qy = vy - vn * ny, qz = vz - vn * nz;
        const double pp = px * px + py * py + pz * pz;
        const double qq = qx * qx + qy * qy + qz * qz;
        const double pq = px * qx + py * qy + pz * qz;
        const double uu = ux * ux + uy * uy + uz * uz;
        constexpr double least = out_of_plane * out_of_plane;
        // Written so that not a number is odd.
        std::uint32_t sound = (pp > least * uu && nn > 1e-60 && nn < 1e60) ? 1U : 0U;

        const double ax = double(next[0][i]) - double(here[0][i]);
        const double ay = double(next[1][i]) - double(here[1][i]);
        const double az = double(next[2][i]) - double(here[2][i]);
        const double bx = double(previous[0][i]) - double(here[0][i]);
        const double by = double(previous[1][i]) - double(here[1][i]);
        const double bz = double(previous[2][i]) - double(here[2][i]);
        const double cx = ay * bz - az * by, cy = az * bx - ax * bz, cz = ax * by - ay * bx;
        double factor = 1.0;
        if constexpr (weight == TangentWeight::angle) {
            const double an = ax * nx + ay * ny + az * nz;
            const double bn = bx * nx + by * ny + bz * nz;
            const double aa = ax * ax + ay * ay + az * az;
            const double bb = bx * bx + by * by + bz * bz;
            sound &= (aa - an * an * per_nn > least * aa && bb - bn * bn * per_nn > least * bb)
                         ? 1U
                         : 0U;
            // Of two vectors in the plane, the cross product is along the normal, and as long as
            // that of the edges is along it.
            const double cosine = ax * bx + ay * by + az * bz - an * bn * per_nn;
            const double sine = std::abs(cx * nx + cy * ny + cz * nz) * std::sqrt(per_nn);
            factor = upper_angle(sine, cosine) / std::sqrt(pp);
        } else if constexpr (weight == TangentWeight::area) {
            factor = 0.5 * std::sqrt(cx * cx + cy * cy + cz * cz) / std::sqrt(pp);
        } else {
            factor = axes.length[i];
        }
        const double x = factor * px, y = factor * py, z = factor * pz;
        const double largest = std::max(std::max(std::abs(x), std::abs(y)), std::abs(z));
        const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) & double_exponent;
        const double scale = std::bit_cast<double>(double_turned - exponent);
        votes.vector[0][i] = to_vote_bits(x * scale);
        votes.vector[1][i] = to_vote_bits(y * scale);
        votes.vector[2][i] = to_vote_bits(z * scale);
        votes.exponent[i] = static_cast<std::int32_t>(exponent >> 52) - 1023 - (vote_bits - 1);
        const std::int32_t skewed = pq * pq < skewed_cosine_squared * (pp * qq) ? 0 : seen_skewed;
        const std::int32_t behind = cx * nx + cy * ny + cz * nz > 0.0 ? 0 : seen_from_behind;
        votes.seen[i] = skewed | behind;
        sound &= (largest > 1e-250 && largest < 1e250) ? 1U : 0U;
        votes.odd[i] = 1U - sound;
    }
}

// Functions of their own: within the loop over blocks, GCC leaves the one over triangles scalar.
RELIEF_TARGET_512 void find_axes_512(const BlockCorners& block, BlockAxes& __restrict axes) {
    find_axes(block, axes);
}
RELIEF_TARGET_256 void find_axes_256(const BlockCorners& block, BlockAxes& __restrict axes) {
    find_axes(block, axes);
}
[[gnu::noinline]] void find_axes_any(const BlockCorners& block, BlockAxes& __restrict axes) {
    find_axes(block, axes);
}
template <TangentWeight weight, std::size_t corner>
RELIEF_TARGET_512 void vote_512(const BlockCorners& block, const BlockAxes& axes,
                                BlockVotes& votes) {
    vote_at_corner<weight, corner>(block, axes, votes);
}
template <TangentWeight weight, std::size_t corner>
RELIEF_TARGET_256 void vote_256(const BlockCorners& block, const BlockAxes& axes,
                                BlockVotes& votes) {
    vote_at_corner<weight, corner>(block, axes, votes);
}
template <TangentWeight weight, std::size_t corner>
[[gnu::noinline]] void vote_any(const BlockCorners& block, const BlockAxes& axes,
                                BlockVotes& votes) {
    vote_at_corner<weight, corner>(block, axes, votes);
}

template <TangentWeight weight>
void vote(const BlockCorners& block, BlockAxes& axes, std::array<BlockVotes, 3>& votes) {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            find_axes_512(block, axes);
            vote_512<weight, 0>(block, axes, votes[0]);
            vote_512<weight, 1>(block, axes, votes[1]);
            vote_512<weight, 2>(block, axes, votes[2]);
            break;
        case VectorTarget::wide:
            find_axes_256(block, axes);
            vote_256<weight, 0>(block, axes, votes[0]);
            vote_256<weight, 1>(block, axes, votes[1]);
            vote_256<weight, 2>(block, axes, votes[2]);
            break;
        case VectorTarget::any:
            find_axes_any(block, axes);
            vote_any<weight, 0>(block, axes, votes[0]);
            vote_any<weight, 1>(block, axes, votes[1]);
            vote_any<weight, 2>(block, axes, votes[2]);
            break;
    }
}

/// What is voted on, and where votes and kinds go.
struct Job {
    const TangentInput& input;
    std::span<glm::vec4> votes;
    std::span<Gradient> kinds;
};

void vote_carefully(const Job& job, TangentWeight weight, std::size_t triangle,
                    std::vector<std::uint32_t>& without) {
    const TriangleVotesAndKind found =
        careful_votes(job.input, weight, job.input.triangles[triangle]);
    job.kinds[triangle] = found.kind;
    if (!has_gradient(found.kind)) without.push_back(static_cast<std::uint32_t>(triangle));
    for (std::size_t k = 0; k < 3; ++k)
        job.votes[3 * triangle + k] = std::bit_cast<glm::vec4>(found.votes[k]);
}

template <TangentWeight weight>
void cast_votes_of(const Job& job, std::size_t begin, std::size_t end,
                   std::vector<std::uint32_t>& without) {
    BlockCorners corners{};
    BlockAxes axes{};
    std::array<BlockVotes, 3> votes{};
    for (std::size_t first = begin; first < end; first += triangles_at_once) {
        const std::size_t count = std::min(triangles_at_once, end - first);
        gather(job.input, first, count, corners);
        vote<weight>(corners, axes, votes);
        for (std::size_t i = 0; i < count; ++i) {
            if ((axes.odd[i] | votes[0].odd[i] | votes[1].odd[i] | votes[2].odd[i]) != 0) {
                vote_carefully(job, weight, first + i, without);
                continue;
            }
            job.kinds[first + i] = axes.side[i] > 0 ? Gradient::upright : Gradient::mirrored;
            for (std::size_t k = 0; k < 3; ++k) {
                const CornerVote vote{votes[k].vector[0][i],
                                      votes[k].vector[1][i],
                                      votes[k].vector[2][i],
                                      static_cast<std::int16_t>(votes[k].exponent[i]),
                                      static_cast<std::int8_t>(axes.side[i]),
                                      static_cast<std::uint8_t>(votes[k].seen[i])};
                job.votes[3 * (first + i) + k] = std::bit_cast<glm::vec4>(vote);
            }
        }
    }
}

}  // namespace

TriangleGradients cast_votes(const TangentInput& input, TangentWeight weight,
                             std::span<glm::vec4> votes) {
    TriangleGradients gradients{std::vector<Gradient>(input.triangles.size()), {}};
    const Job job{input, votes, gradients.kinds};
    std::mutex guard;
    parallel_for(input.triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> without;
        switch (weight) {
            case TangentWeight::angle:
                cast_votes_of<TangentWeight::angle>(job, begin, end, without);
                break;
            case TangentWeight::area:
                cast_votes_of<TangentWeight::area>(job, begin, end, without);
                break;
            case TangentWeight::stretch:
                cast_votes_of<TangentWeight::stretch>(job, begin, end, without);
                break;
        }
        if (without.empty()) return;
        const std::scoped_lock lock(guard);
        gradients.without.insert(gradients.without.end(), without.begin(), without.end());
    });
    std::sort(gradients.without.begin(), gradients.without.end());
    return gradients;
}

}  // namespace relief
