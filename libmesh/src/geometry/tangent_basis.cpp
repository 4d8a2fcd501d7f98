// SPDX-License-Identifier: Apache-2.0
// Compares stored tangents with those of every known method, corner by corner, in degrees in the
// plane of the normal. Corners whose direction is not certain are left out and counted.
//
// The gradient of the texture coordinates solves position = origin + u * along_u + v * along_v over
// one triangle, for any float values. tangent_contributions.cpp does the same for many ordinary
// triangles at once.
#include "relief/mesh/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/corners.h"
#include "geometry/direction.h"
#include "geometry/texture_gradient.h"
#include "parallel.h"
#include "portable_math.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr std::size_t grain = 2048;

/// Differences from float arithmetic in another order, in degrees, with a margin for exporters that
/// convert positions and normals.
constexpr double float_tolerance = 0.1;
/// Half a step of 1/127 in each of three components: 0.39 degrees.
constexpr double tolerance_of_8_bits = 0.5;
constexpr double share_needed = 0.95;
/// Two means that differ by no more than this, or by no more than this factor, are equally good.
constexpr double means_alike = 0.002;
constexpr double factor_alike = 1.5;

/// One method: three tangents for each triangle.
struct Method {
    TangentMethod method;
    std::vector<glm::vec4> (*tangents)(const Mesh& mesh);
};

/// Returns the u direction of each triangle, not averaged.
std::vector<glm::vec4> triangle_tangents(const Mesh& mesh) {
    std::vector<glm::vec4> result(3 * mesh.triangles.size());
    parallel_for(mesh.triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const TriangleGradient gradient =
                triangle_gradient(mesh.positions, mesh.texcoords, mesh.triangles[t]);
            const float w = gradient.kind == Gradient::mirrored ? -1.0F : 1.0F;
            std::fill_n(result.begin() + static_cast<std::ptrdiff_t>(3 * t), 3,
                        glm::vec4(gradient.along_u, w));
        }
    });
    return result;
}

template <auto Function>
std::vector<glm::vec4> tangents_by(const Mesh& mesh) {
    Report ignored;  // Degenerate corners are left out here.
    return Function(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, ignored);
}

constexpr std::array methods = {
    Method{TangentMethod::mikktspace, tangents_by<mikktspace_tangents>},
    Method{TangentMethod::area_weighted, tangents_by<area_weighted_tangents>},
    Method{TangentMethod::lengyel, tangents_by<lengyel_tangents>},
    Method{TangentMethod::triangle, triangle_tangents},
};

/// Returns 8 or 16 if all values are multiples of the step of signed integers with that many bits;
/// 0 otherwise, or if all are 0 and 1.
int stored_bits(std::span<const glm::vec4> tangents) {
    const auto are_multiples = [&](double steps) {
        return std::all_of(tangents.begin(), tangents.end(), [&](const glm::vec4& tangent) {
            for (int i = 0; i < 3; ++i) {
                const double value = static_cast<double>(tangent[i]) * steps;
                if (std::abs(value - std::nearbyint(value)) > 1e-4 * std::sqrt(steps)) return false;
            }
            return true;
        });
    };
    if (are_multiples(1.0)) return 0;  // Axis-aligned values carry no information.
    if (are_multiples(127.0)) return 8;
    return are_multiples(32767.0) ? 16 : 0;
}

/// Height of a triangle over its longest side, that side, and its largest coordinate.
template <int N>
struct Slenderness {
    double height = 0.0;
    double longest = 0.0;
    double largest = 0.0;

    Slenderness(const std::array<glm::vec<N, double>, 3>& corners, double twice_area) {
        for (int k = 0; k < 3; ++k) {
            const auto& corner = corners[static_cast<std::size_t>(k)];
            longest = std::max(
                longest, glm::length(corners[static_cast<std::size_t>((k + 1) % 3)] - corner));
            for (int i = 0; i < N; ++i)
                largest = std::max(largest, std::abs(corner[i]));
        }
        height = longest > 0.0 ? twice_area / longest : 0.0;
    }

    /// NaN and infinity are not certain.
    [[nodiscard]] bool is_certain() const {
        constexpr double spacings = 1000.0;  // Rotates it by at most 0.06 degrees.
        constexpr double thinnest = 1e-6;
        constexpr double float_spacing = 1.2e-7;
        return height > spacings * float_spacing * largest && height > thinnest * longest &&
               std::isfinite(longest);
    }
};

/// Tests whether rounding of its corners preserves the direction of a triangle's gradient.
bool has_certain_gradient(const Mesh& mesh, const glm::uvec3& triangle) {
    std::array<glm::dvec3, 3> p{};
    std::array<glm::dvec2, 3> t{};
    for (int k = 0; k < 3; ++k) {
        p[static_cast<std::size_t>(k)] = mesh.positions[triangle[k]];
        t[static_cast<std::size_t>(k)] = mesh.texcoords[triangle[k]];
    }
    const glm::dvec2 along = t[1] - t[0];
    const glm::dvec2 across = t[2] - t[0];
    const double in_image = std::abs(along.x * across.y - along.y * across.x);
    const double in_space = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    return Slenderness<3>(p, in_space).is_certain() && Slenderness<2>(t, in_image).is_certain();
}

/// Returns the certainty of each corner: 1 certain, 0 uncertain, 2 if the stored tangent is
/// invalid.
std::vector<unsigned char> judge_corners(const Mesh& mesh) {
    std::vector<unsigned char> kinds(3 * mesh.triangles.size(), 0);
    parallel_for(mesh.triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const glm::uvec3& triangle = mesh.triangles[t];
            if (!has_certain_gradient(mesh, triangle)) continue;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 normal = direction_or_zero(glm::dvec3(mesh.normals[triangle[k]]));
                if (normal == glm::dvec3(0.0)) continue;
                const glm::dvec3 tangent =
                    direction_or_zero(glm::dvec3(mesh.tangents[triangle[k]]));
                constexpr double along_normal = 1e-3;
                const bool is_direction = glm::length(in_plane(tangent, normal)) > along_normal;
                kinds[3 * t + static_cast<std::size_t>(k)] = is_direction ? 1 : 2;
            }
        }
    });
    return kinds;
}

/// Returns the rotation of a stored tangent relative to a method's, counter-clockwise towards its
/// bitangent, in degrees, -180 to 180; NaN if the method has none.
float turn_of(const glm::vec4& stored, const glm::vec4& computed, const glm::vec3& normal) {
    const glm::dvec3 n = direction_or_zero(glm::dvec3(normal));
    const glm::dvec3 t = in_plane(glm::dvec3(computed), n);
    const glm::dvec3 b = glm::cross(n, t) * static_cast<double>(computed.w);
    const glm::dvec3 s(stored);
    const double x = glm::dot(s, t);
    const double y = glm::dot(s, b);
    if (x == 0.0 && y == 0.0) return std::numeric_limits<float>::quiet_NaN();
    constexpr float degrees = 180.0F / std::numbers::pi_v<float>;
    return static_cast<float>(portable::atan2(y, x)) * degrees;
}

/// Returns the angle in degrees, 0 to 180, to the direction after `turns` quarter turns.
float degrees_off(float turn, int quarter_turns) {
    const float apart = std::abs(turn - 90.0F * static_cast<float>(quarter_turns));
    return apart > 180.0F ? std::abs(360.0F - apart) : apart;
}

/// Compares the stored tangents of all certain corners with a method's.
TangentAgreement agreement_with(const Method& method, const Mesh& mesh,
                                std::span<const unsigned char> kinds, double tolerance) {
    const std::vector<glm::vec4> computed = method.tangents(mesh);
    std::vector<float> turns(computed.size(), std::numeric_limits<float>::quiet_NaN());
    parallel_for(computed.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t corner = begin; corner < end; ++corner) {
            if (kinds[corner] != 1) continue;
            const std::uint32_t v = vertex_of(static_cast<Corner>(corner), mesh.triangles);
            turns[corner] = turn_of(mesh.tangents[v], computed[corner], mesh.normals[v]);
        }
    });
    TangentAgreement result;
    result.method = method.method;
    for (const float turn : turns) {
        for (int quarter = 0; quarter < 4; ++quarter)
            result.within[static_cast<std::size_t>(quarter)] +=
                static_cast<double>(degrees_off(turn, quarter)) <= tolerance ? 1 : 0;
    }
    result.quarter_turns = static_cast<int>(
        std::max_element(result.within.begin(), result.within.end()) - result.within.begin());
    std::vector<float> angles;
    double sum = 0.0;
    for (std::size_t corner = 0; corner < turns.size(); ++corner) {
        if (kinds[corner] != 1) continue;
        const float angle = degrees_off(turns[corner], result.quarter_turns);
        angles.push_back(angle);
        sum += angle <= tolerance ? static_cast<double>(angle) : tolerance;
        if (!(static_cast<double>(angle) <= tolerance)) continue;
        const std::uint32_t v = vertex_of(static_cast<Corner>(corner), mesh.triangles);
        result.negated += (mesh.tangents[v].w < 0.0F) != (computed[corner].w < 0.0F) ? 1 : 0;
    }
    if (!angles.empty()) result.mean_clamped = sum / static_cast<double>(angles.size());
    result.angles = error_stats(std::move(angles));
    return result;
}

/// Smallest mean of the methods that agree, and the methods that are equally good.
void choose(IdentifiedTangents& result) {
    const TangentAgreement* best = nullptr;
    for (const TangentAgreement& agreement : result.agreements) {
        if (agreement.fraction() < share_needed) continue;
        if (best == nullptr ||
            agreement.mean_clamped * factor_alike + means_alike < best->mean_clamped)
            best = &agreement;
    }
    if (best == nullptr) return;
    result.method = best->method;
    for (const TangentAgreement& agreement : result.agreements) {
        if (&agreement == best || agreement.fraction() < share_needed) continue;
        if (agreement.mean_clamped <= best->mean_clamped * factor_alike + means_alike)
            result.equivalent_methods.push_back(agreement.method);
    }
}

}  // namespace

double TangentAgreement::fraction() const {
    const std::size_t all = angles.count + angles.undefined;
    return all == 0 ? 0.0 : static_cast<double>(agreeing()) / static_cast<double>(all);
}

const TangentAgreement* IdentifiedTangents::best() const {
    if (agreements.empty()) return nullptr;
    if (method) {
        return &*std::find_if(agreements.begin(), agreements.end(),
                              [&](const TangentAgreement& a) { return a.method == *method; });
    }
    // A method whose tangents are all parallel to the normals has no angles, and their mean would
    // be 0.
    const auto mean_of = [](const TangentAgreement& a) {
        return a.angles.count != 0 ? a.angles.mean : std::numeric_limits<double>::infinity();
    };
    return &*std::min_element(agreements.begin(), agreements.end(),
                              [&](const TangentAgreement& a, const TangentAgreement& b) {
                                  return mean_of(a) < mean_of(b);
                              });
}

bool IdentifiedTangents::is_clearly_best() const {
    constexpr double factor = 1.5;
    const TangentAgreement* nearest = best();
    return nearest != nullptr &&
           std::all_of(agreements.begin(), agreements.end(), [&](const TangentAgreement& other) {
               return &other == nearest || other.angles.count == 0 ||
                      other.angles.mean >= factor * nearest->angles.mean;
           });
}

IdentifiedTangents identify_tangents(const Mesh& mesh) {
    validate(mesh);
    IdentifiedTangents result;
    if (mesh.tangents.empty() || mesh.normals.empty() || mesh.texcoords.empty()) return result;
    result.stored_bits = stored_bits(mesh.tangents);
    result.tolerance = result.stored_bits == 8 ? tolerance_of_8_bits : float_tolerance;
    const std::vector<unsigned char> kinds = judge_corners(mesh);
    result.corners = static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), 1));
    result.undefined = static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), 2));
    result.left_out = kinds.size() - result.corners - result.undefined;
    if (result.corners == 0) return result;
    for (const Method& method : methods)
        result.agreements.push_back(agreement_with(method, mesh, kinds, result.tolerance));
    choose(result);
    return result;
}

std::string_view variant_text(int quarter_turns, bool is_negated) {
    static constexpr std::array<std::string_view, 8> words = {
        "",
        "w negated",
        "turned by a quarter",
        "tangent and bitangent exchanged",
        "turned by half a turn",
        "u mirrored",
        "turned by three quarters",
        "tangent and bitangent exchanged and negated",
    };
    return words.at(2 * static_cast<std::size_t>(quarter_turns) + (is_negated ? 1 : 0));
}

namespace {

/// Returns the texture coordinate with v upwards. Only differences matter.
glm::vec2 upright(const glm::vec2& texcoord) {
    return {texcoord.x, -texcoord.y};
}

/// Returns b - a in float, like the reference implementation, or in double if float overflows.
double float_difference(float a, float b) {
    const float difference = b - a;
    return std::isfinite(difference) ? difference : static_cast<double>(b) - a;
}

/// Two edges of a triangle from its first corner, in float, scaled by a power of two so that the
/// largest component is 1 or slightly more. No significant digit changes, and no later product
/// overflows or underflows.
template <std::size_t N>
struct Edges {
    std::array<float, N> first;
    std::array<float, N> second;
    int exponent = 0;  ///< The scale is 2^-exponent.

    explicit Edges(const glm::vec<static_cast<int>(N), float> (&corners)[3]) {
        std::array<double, N> to_second;
        std::array<double, N> to_third;
        double largest = 0.0;
        for (std::size_t i = 0; i < N; ++i) {
            const int k = static_cast<int>(i);
            to_second[i] = float_difference(corners[0][k], corners[1][k]);
            to_third[i] = float_difference(corners[0][k], corners[2][k]);
            largest = std::max({largest, std::abs(to_second[i]), std::abs(to_third[i])});
        }
        if (largest != 0.0) exponent = std::ilogb(largest);
        for (std::size_t i = 0; i < N; ++i) {
            first[i] = static_cast<float>(std::ldexp(to_second[i], -exponent));
            second[i] = static_cast<float>(std::ldexp(to_third[i], -exponent));
        }
    }
};

/// Normalizes with the operations of the reference implementation, within the range of float.
glm::vec3 float_direction(const std::array<float, 3>& axis, float sign) {
    constexpr float least = 1e-18F;  // Its square is a normal number.
    const glm::vec3 vector(axis[0], axis[1], axis[2]);
    const float length = glm::length(vector);
    return length > least ? sign / length * vector
                          : glm::vec3(double(sign) * direction_or_zero(glm::dvec3(vector)));
}

TriangleGradient gradient_of(const glm::vec3 (&p)[3], const glm::vec2 (&t)[3]) {
    for (int i = 0; i < 3; ++i) {
        if (!is_finite(p[i]) || !is_finite(t[i])) return {.kind = Gradient::non_finite};
    }
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return {.kind = Gradient::coinciding};

    const Edges<3> d(p);
    const Edges<2> s(t);
    const TextureAxes axes = texture_axes(d.first, d.second, s.first, s.second);
    constexpr std::array nowhere = {0.0F, 0.0F, 0.0F};
    if (axes.area == 0.0F || axes.u == nowhere || axes.v == nowhere) return {};
    const float sign = axes.area > 0.0F ? 1.0F : -1.0F;
    const double length = glm::length(glm::dvec3(axes.u[0], axes.u[1], axes.u[2]));
    return {.kind = axes.area > 0.0F ? Gradient::upright : Gradient::mirrored,
            .along_u = float_direction(axes.u, sign),
            .along_v = float_direction(axes.v, sign),
            .stretch = std::ldexp(length / std::abs(static_cast<double>(axes.area)),
                                  d.exponent - s.exponent)};
}

}  // namespace

TriangleGradient detail::triangle_gradient(StridedSpan<const glm::vec3> positions,
                                           StridedSpan<const glm::vec2> texcoords,
                                           const glm::uvec3& triangle) {
    const glm::vec3 p[] = {positions[triangle.x], positions[triangle.y], positions[triangle.z]};
    const glm::vec2 t[] = {upright(texcoords[triangle.x]), upright(texcoords[triangle.y]),
                           upright(texcoords[triangle.z])};
    return gradient_of(p, t);
}

std::vector<Gradient> detail::gradient_kinds(StridedSpan<const glm::vec3> positions,
                                             StridedSpan<const glm::vec2> texcoords,
                                             TriangleSpan triangles) {
    std::vector<Gradient> kinds(triangles.size());
    parallel_for(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            kinds[i] = triangle_gradient(positions, texcoords, triangles[i]).kind;
    });
    return kinds;
}

}  // namespace relief
