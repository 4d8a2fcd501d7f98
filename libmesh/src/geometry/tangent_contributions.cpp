// SPDX-License-Identifier: Apache-2.0
// Contributions of triangles to tangents: one by one, for every value that a float can have, and in
// blocks.
//
// A block gathers corners into arrays and computes on whole vector registers. Triangles with
// unusual values (no gradient, a value that is not finite, a normal or an edge without direction,
// numbers at the ends of float's range) are then computed again, one by one.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <mutex>
#include <numbers>

#include "geometry/direction.h"
#include "geometry/gather.h"
#include "geometry/tangent_contributions.h"
#include "parallel.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

// Weight of a corner without angle or area. Its direction counts only if there is no other: the
// weight is less than any weight of finite floats.
constexpr double min_weight = 1e-200;

/// Returns the angle of the corner in the plane of the normal. An edge parallel to the normal has
/// no direction in the plane; like the reference implementation, such a corner counts as a right
/// angle.
double seen_angle(const glm::dvec3& here, const glm::dvec3& next, const glm::dvec3& previous,
                  const glm::dvec3& normal) {
    const glm::dvec3 a = direction_in_plane(next - here, normal);
    const glm::dvec3 b = direction_in_plane(previous - here, normal);
    if (a == glm::dvec3(0.0) || b == glm::dvec3(0.0)) return std::numbers::pi / 2.0;
    return upper_angle(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

glm::dvec3 direction_in_plane(const glm::dvec3& vector, const glm::dvec3& normal) {
    const glm::dvec3 projected = in_plane(vector, normal);
    return glm::length(projected) > out_of_plane * glm::length(vector)
               ? direction_or_zero(projected)
               : glm::dvec3(0.0);
}

CornerContribution contribution_of(const glm::dvec3& vector, std::int8_t side, std::uint8_t seen) {
    const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    if (!(largest > 0.0) || !std::isfinite(largest)) return {};
    const int exponent = std::ilogb(largest) - (contribution_bits - 1);
    const auto scaled = [&](double number) {
        return static_cast<std::int32_t>(std::ldexp(number, -exponent));
    };
    return {scaled(vector.x),
            scaled(vector.y),
            scaled(vector.z),
            static_cast<std::int16_t>(exponent),
            side,
            seen};
}

TriangleContributionsAndKind contributions_of_any(const TangentInput& input, TangentWeight weight,
                                                  const glm::uvec3& triangle) {
    const TriangleGradient gradient = triangle_gradient(input.positions, input.texcoords, triangle);
    TriangleContributionsAndKind result{gradient.kind, {}};
    if (!has_gradient(gradient.kind)) return result;
    const std::int8_t side = gradient.kind == Gradient::upright ? 1 : -1;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 here(input.positions[triangle[k]]);
        const glm::dvec3 next(input.positions[triangle[(k + 1) % 3]]);
        const glm::dvec3 previous(input.positions[triangle[(k + 2) % 3]]);
        const glm::dvec3 normal = direction_or_zero(glm::dvec3(input.normals[triangle[k]]));
        const glm::dvec3 u(gradient.along_u);
        const glm::dvec3 along_u = direction_in_plane(u, normal);
        const glm::dvec3 along_v = direction_in_plane(glm::dvec3(gradient.along_v), normal);
        double length = 1.0;
        switch (weight) {
            case TangentWeight::angle:
                length = seen_angle(here, next, previous, normal);
                break;
            case TangentWeight::area:
                length = 0.5 * glm::length(glm::cross(next - here, previous - here));
                break;
            case TangentWeight::stretch:
                length = gradient.stretch * glm::length(in_plane(u, normal));
                break;
        }
        const double cosine = glm::dot(along_u, along_v);
        const bool faces = glm::dot(glm::cross(next - here, previous - here), normal) > 0.0;
        const bool skewed =
            !(cosine * cosine < skewed_cosine_squared) || along_v == glm::dvec3(0.0);
        const int seen = (skewed ? seen_skewed : 0) | (faces ? 0 : seen_from_behind);
        result.contributions[static_cast<std::size_t>(k)] = contribution_of(
            std::max(length, min_weight) * along_u, side, static_cast<std::uint8_t>(seen));
    }
    return result;
}

namespace {

constexpr std::size_t triangles_at_once = 64;

/// One value per triangle of a block.
template <typename T>
struct alignas(64) PerTriangle : std::array<T, triangles_at_once> {};

template <typename T, std::size_t N>
using Vectors = std::array<PerTriangle<T>, N>;

/// Corners of a block, with v upwards.
struct BlockCorners {
    std::array<Vectors<float, 3>, 3> position;
    std::array<Vectors<float, 3>, 3> normal;
    std::array<Vectors<float, 2>, 3> texcoord;
};

/// Texture gradients of the triangles of a block.
struct BlockAxes {
    Vectors<float, 3> u;  ///< Direction of increasing u.
    Vectors<float, 3> v;  ///< Direction of increasing v (upwards).
    /// Length of the true gradient along u, divided by the length of `u`.
    PerTriangle<double> length;
    PerTriangle<float> side;         ///< 1, or -1 if mirrored.
    PerTriangle<std::uint32_t> odd;  ///< 1 if the other values may be undefined.
};

/// Contributions at one corner of every triangle of a block.
struct BlockContributions {
    Vectors<std::int32_t, 3> vector;
    PerTriangle<std::int32_t> rest;  ///< The other members of CornerContribution.
    PerTriangle<std::uint32_t> odd;
};

/// The bits of exponent, side and seen.
RELIEF_INLINE std::int32_t rest_of(std::int32_t exponent, std::int32_t side, std::int32_t seen) {
    static_assert(std::endian::native == std::endian::little);
    return (exponent & 0xFFFF) | (side & 0xFF) << 16 | seen << 24;
}

/// Loads corners one by one, for blocks that are not full or that use the last vertex.
void gather_each(const TangentInput& input, std::span<const glm::uvec3> triangles,
                 BlockCorners& block) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = triangles[i][static_cast<int>(k)];
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

/// Loads the texture coordinates of one corner of four triangles, with v upwards.
RELIEF_INLINE void gather_four_texcoords(const StridedSpan<const glm::vec2>& texcoords,
                                         const glm::uvec3* triangles, int corner, float* u,
                                         float* v) {
    const auto* const first = reinterpret_cast<const std::byte*>(texcoords.data());
    const std::size_t stride = texcoords.stride();
    FourFloats ab, cd;
    std::array<double, 2> pair;  // Moves 8 bytes at a time.
    std::memcpy(&pair[0], first + stride * triangles[0][corner], sizeof pair[0]);
    std::memcpy(&pair[1], first + stride * triangles[1][corner], sizeof pair[1]);
    std::memcpy(&ab, pair.data(), sizeof ab);
    std::memcpy(&pair[0], first + stride * triangles[2][corner], sizeof pair[0]);
    std::memcpy(&pair[1], first + stride * triangles[3][corner], sizeof pair[1]);
    std::memcpy(&cd, pair.data(), sizeof cd);
    const FourFloats us = __builtin_shufflevector(ab, cd, 0, 2, 4, 6);
    const FourFloats vs = -__builtin_shufflevector(ab, cd, 1, 3, 5, 7);
    std::memcpy(u, &us, sizeof us);
    std::memcpy(v, &vs, sizeof vs);
}

/// Loads the corners of a full block.
RELIEF_INLINE void gather_all(const TangentInput& input, std::span<const glm::uvec3> triangles,
                              BlockCorners& block) {
    for (std::size_t i = 0; i < triangles_at_once; i += 4) {
        for (int k = 0; k < 3; ++k) {
            auto& [x, y, z] = block.position[static_cast<std::size_t>(k)];
            auto& [nx, ny, nz] = block.normal[static_cast<std::size_t>(k)];
            auto& [u, v] = block.texcoord[static_cast<std::size_t>(k)];
            gather_four(input.positions, &triangles[i], k, &x[i], &y[i], &z[i]);
            gather_four(input.normals, &triangles[i], k, &nx[i], &ny[i], &nz[i]);
            gather_four_texcoords(input.texcoords, &triangles[i], k, &u[i], &v[i]);
        }
    }
}

// Exponent of a float, and the bits of 2^(254 - exponent).
constexpr std::uint32_t float_exponent = 0x7f800000U;
constexpr std::uint32_t float_turned = 254U << 23;

/// Returns the largest absolute value of three numbers.
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
        // A sum propagates NaN, but a maximum does not.
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
        // Gradient = axis / area. Edges are scaled.
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

// Exponent of a double, and the bits of 2^(contribution_bits - 1 - exponent).
constexpr std::uint64_t double_exponent = 0x7ff0000000000000ULL;
constexpr std::uint64_t double_turned = std::uint64_t(2046 + contribution_bits - 1) << 52;

/// Clamps to the range of a contribution. NaN, in odd triangles, becomes a number.
RELIEF_INLINE std::int32_t to_contribution_bits(double number) {
    constexpr double limit = 1 << contribution_bits;
    return static_cast<std::int32_t>(std::min(std::max(-limit, number), limit));
}

template <TangentWeight weight, std::size_t corner>
RELIEF_INLINE void contribution_at_corner(const BlockCorners& block, const BlockAxes& axes,
                                          BlockContributions& contributions) {
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
        // Projects onto the plane of the normal.
        const double px = ux - un * nx, py = uy - un * ny, pz = uz - un * nz;
        const double qx = vx - vn * nx, qy = vy - vn * ny, qz = vz - vn * nz;
        const double pp = px * px + py * py + pz * pz;
        const double qq = qx * qx + qy * qy + qz * qz;
        const double pq = px * qx + py * qy + pz * qz;
        const double uu = ux * ux + uy * uy + uz * uz;
        constexpr double least = out_of_plane * out_of_plane;
        // The condition is true for NaN.
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
            // The cross product of two vectors in the plane is parallel to the normal. Its length
            // equals the component along the normal of the edges' cross product.
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
        contributions.vector[0][i] = to_contribution_bits(x * scale);
        contributions.vector[1][i] = to_contribution_bits(y * scale);
        contributions.vector[2][i] = to_contribution_bits(z * scale);
        const std::int32_t skewed = pq * pq < skewed_cosine_squared * (pp * qq) ? 0 : seen_skewed;
        const std::int32_t behind = cx * nx + cy * ny + cz * nz > 0.0 ? 0 : seen_from_behind;
        contributions.rest[i] =
            rest_of(static_cast<std::int32_t>(exponent >> 52) - 1023 - (contribution_bits - 1),
                    static_cast<std::int32_t>(axes.side[i]), skewed | behind);
        sound &= (largest > 1e-250 && largest < 1e250) ? 1U : 0U;
        contributions.odd[i] = 1U - sound;
    }
}

// Separate functions: inside the loop over blocks, GCC does not vectorize the loop over triangles.
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
RELIEF_TARGET_512 void contribution_512(const BlockCorners& block, const BlockAxes& axes,
                                        BlockContributions& contributions) {
    contribution_at_corner<weight, corner>(block, axes, contributions);
}
template <TangentWeight weight, std::size_t corner>
RELIEF_TARGET_256 void contribution_256(const BlockCorners& block, const BlockAxes& axes,
                                        BlockContributions& contributions) {
    contribution_at_corner<weight, corner>(block, axes, contributions);
}
template <TangentWeight weight, std::size_t corner>
[[gnu::noinline]] void contribution_any(const BlockCorners& block, const BlockAxes& axes,
                                        BlockContributions& contributions) {
    contribution_at_corner<weight, corner>(block, axes, contributions);
}

template <TangentWeight weight>
void contribution(const BlockCorners& block, BlockAxes& axes,
                  std::array<BlockContributions, 3>& contributions) {
    switch (best_vector_target()) {
        case VectorTarget::widest:
            find_axes_512(block, axes);
            contribution_512<weight, 0>(block, axes, contributions[0]);
            contribution_512<weight, 1>(block, axes, contributions[1]);
            contribution_512<weight, 2>(block, axes, contributions[2]);
            break;
        case VectorTarget::wide:
            find_axes_256(block, axes);
            contribution_256<weight, 0>(block, axes, contributions[0]);
            contribution_256<weight, 1>(block, axes, contributions[1]);
            contribution_256<weight, 2>(block, axes, contributions[2]);
            break;
        case VectorTarget::any:
            find_axes_any(block, axes);
            contribution_any<weight, 0>(block, axes, contributions[0]);
            contribution_any<weight, 1>(block, axes, contributions[1]);
            contribution_any<weight, 2>(block, axes, contributions[2]);
            break;
    }
}

/// Input of the contributions, and the output arrays.
struct Job {
    const TangentInput& input;
    std::span<glm::vec4> contributions;
    std::span<Gradient> kinds;
};

void contribution_of_any(const Job& job, TangentWeight weight, std::size_t triangle,
                         std::vector<std::uint32_t>& without) {
    const TriangleContributionsAndKind found =
        contributions_of_any(job.input, weight, job.input.triangles[triangle]);
    job.kinds[triangle] = found.kind;
    if (!has_gradient(found.kind)) without.push_back(static_cast<std::uint32_t>(triangle));
    for (std::size_t k = 0; k < 3; ++k)
        job.contributions[3 * triangle + k] = std::bit_cast<glm::vec4>(found.contributions[k]);
}

/// Stores the contributions of a full block at one corner of its triangles.
RELIEF_INLINE void store_corner(const BlockContributions& block, glm::vec4* first) {
    for (std::size_t i = 0; i < triangles_at_once; i += 4) {
        FourInts a, b, c, d;
        std::memcpy(&a, &block.vector[0][i], sizeof a);
        std::memcpy(&b, &block.vector[1][i], sizeof b);
        std::memcpy(&c, &block.vector[2][i], sizeof c);
        std::memcpy(&d, &block.rest[i], sizeof d);
        transpose(a, b, c, d);
        std::memcpy(&first[3 * i], &a, sizeof a);
        std::memcpy(&first[3 * i + 3], &b, sizeof b);
        std::memcpy(&first[3 * i + 6], &c, sizeof c);
        std::memcpy(&first[3 * i + 9], &d, sizeof d);
    }
}

/// Stores the contributions of `count` triangles.
void store_each(const std::array<BlockContributions, 3>& block, std::size_t count,
                glm::vec4* first) {
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            first[3 * i + k] =
                std::bit_cast<glm::vec4>(std::array{block[k].vector[0][i], block[k].vector[1][i],
                                                    block[k].vector[2][i], block[k].rest[i]});
        }
    }
}

template <TangentWeight weight>
void compute_contributions_of(const Job& job, std::size_t begin, std::size_t end,
                              std::vector<std::uint32_t>& without) {
    BlockCorners corners{};
    BlockAxes axes{};
    std::array<BlockContributions, 3> contributions{};
    std::array<glm::uvec3, triangles_at_once> wide;
    for (std::size_t first = begin; first < end; first += triangles_at_once) {
        const std::size_t count = std::min(triangles_at_once, end - first);
        const auto block = block_of(job.input.triangles, first, count, wide);
        const bool is_full = count == triangles_at_once;
        if (is_full && range_of(block).highest + 1 < job.input.positions.size())
            gather_all(job.input, block, corners);
        else
            gather_each(job.input, block, corners);
        contribution<weight>(corners, axes, contributions);
        glm::vec4* const results = &job.contributions[3 * first];
        if (is_full) {
            for (std::size_t k = 0; k < 3; ++k)
                store_corner(contributions[k], results + k);
        } else {
            store_each(contributions, count, results);
        }
        std::uint32_t any_odd = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t odd = axes.odd[i] | contributions[0].odd[i] |
                                      contributions[1].odd[i] | contributions[2].odd[i];
            axes.odd[i] = odd;
            any_odd |= odd;
            job.kinds[first + i] = axes.side[i] > 0 ? Gradient::upright : Gradient::mirrored;
        }
        if (any_odd == 0) continue;
        for (std::size_t i = 0; i < count; ++i) {
            if (axes.odd[i] != 0) contribution_of_any(job, weight, first + i, without);
        }
    }
}

}  // namespace

TriangleGradients compute_contributions(const TangentInput& input, TangentWeight weight,
                                        std::span<glm::vec4> contributions) {
    TriangleGradients gradients{std::vector<Gradient>(input.triangles.size()), {}};
    const Job job{input, contributions, gradients.kinds};
    std::mutex guard;
    parallel_for(input.triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> without;
        switch (weight) {
            case TangentWeight::angle:
                compute_contributions_of<TangentWeight::angle>(job, begin, end, without);
                break;
            case TangentWeight::area:
                compute_contributions_of<TangentWeight::area>(job, begin, end, without);
                break;
            case TangentWeight::stretch:
                compute_contributions_of<TangentWeight::stretch>(job, begin, end, without);
                break;
        }
        if (without.empty()) return;
        const std::scoped_lock lock(guard);
        gradients.without.insert(gradients.without.end(), without.begin(), without.end());
    });
    std::sort(gradients.without.begin(), gradients.without.end());
    return gradients;
}

void compute_contributions(const TangentInput& input, std::span<glm::vec4> contributions,
                           std::span<Gradient> kinds, std::vector<std::uint32_t>& without) {
    const Job job{input, contributions, kinds};
    compute_contributions_of<TangentWeight::angle>(job, 0, input.triangles.size(), without);
}

}  // namespace relief::detail
