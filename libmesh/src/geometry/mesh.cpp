// SPDX-License-Identifier: Apache-2.0
// Checks of meshes, bounds, parts, and transformed meshes and texture coordinates.
//
// The check of indices first finds the largest one, which is as fast as reading memory, and
// searches only if it is too large. Normals are transformed by the matrix of cofactors, which is
// the inverse transpose except for a factor, and exists for singular matrices too.
#include "relief/mesh/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "geometry/check_triangles.h"
#include "geometry/direction.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The largest index of one triangle or more.
std::uint32_t largest_index(const TriangleSpan& triangles) {
    std::atomic<std::uint32_t> largest = 0;
    parallel_for(triangles.size(), 65536, [&](std::size_t begin, std::size_t end) {
        std::uint32_t most = 0;
        if (triangles.longs() != nullptr) {
            const std::uint32_t* const indices = &triangles.longs()->x;
            for (std::size_t i = 3 * begin; i < 3 * end; ++i)
                most = std::max(most, indices[i]);
        } else {
            for (std::size_t t = begin; t < end; ++t) {
                const glm::uvec3 triangle = triangles[t];
                most = std::max({most, triangle.x, triangle.y, triangle.z});
            }
        }
        std::uint32_t before = largest;
        while (before < most && !largest.compare_exchange_weak(before, most)) {
        }
    });
    return largest;
}

}  // namespace

std::optional<std::size_t> detail::corner_beyond(TriangleSpan triangles, std::size_t vertex_count) {
    if (triangles.empty() || largest_index(triangles) < vertex_count) return std::nullopt;
    for (std::size_t corner = 0;; ++corner) {
        if (triangles[corner / 3][static_cast<int>(corner % 3)] >= vertex_count) return corner;
    }
}

void detail::check_triangles(TriangleSpan triangles, std::size_t vertex_count) {
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() / 3;
    if (triangles.size() > most) {
        throw InvalidInput(fmt::format(
            "there are {} triangles, but no more than {} can be numbered", triangles.size(), most));
    }
    const std::optional<std::size_t> corner = corner_beyond(triangles, vertex_count);
    if (!corner) return;
    const std::uint32_t vertex = triangles[*corner / 3][static_cast<int>(*corner % 3)];
    const auto as_signed = static_cast<std::int32_t>(vertex);
    throw InvalidInput(fmt::format(
        "triangle {} names vertex {}{}, but there are only {}", *corner / 3, vertex,
        as_signed < 0 ? fmt::format(" ({} as a signed index)", as_signed) : "", vertex_count));
}

namespace {

void check_length(const Mesh& mesh, std::size_t length, std::string_view attribute) {
    if (length != 0 && length != mesh.positions.size()) {
        throw InvalidInput(fmt::format("there are {} {}, but {} positions", length, attribute,
                                       mesh.positions.size()));
    }
}

void check_ranges(const Mesh& mesh) {
    std::size_t covered = 0;
    for (const MaterialRange& range : mesh.material_ranges) {
        if (range.first_triangle != covered) {
            throw InvalidInput(fmt::format("a material range starts at triangle {} instead of {}",
                                           range.first_triangle, covered));
        }
        covered += range.triangle_count;
    }
    if (!mesh.material_ranges.empty() && covered != mesh.triangles.size()) {
        throw InvalidInput(fmt::format("material ranges cover {} triangles, but there are {}",
                                       covered, mesh.triangles.size()));
    }
}

}  // namespace

Bounds bounds_of(const Mesh& mesh) {
    Bounds bounds;
    for (const glm::vec3& position : mesh.positions) {
        if (!is_finite(position)) continue;
        bounds.min = glm::min(bounds.min, position);
        bounds.max = glm::max(bounds.max, position);
    }
    return bounds;
}

void validate(const Mesh& mesh) {
    check_length(mesh, mesh.normals.size(), "normals");
    check_length(mesh, mesh.texcoords.size(), "texture coordinates");
    check_length(mesh, mesh.texcoords_2.size(), "second texture coordinates");
    check_length(mesh, mesh.tangents.size(), "tangents");
    check_length(mesh, mesh.colors.size(), "colors");
    check_triangles(mesh.triangles, mesh.positions.size());
    check_ranges(mesh);
    if (!mesh.smoothing_groups.empty() && mesh.smoothing_groups.size() != mesh.triangles.size()) {
        throw InvalidInput(fmt::format("there are {} smoothing groups, but {} triangles",
                                       mesh.smoothing_groups.size(), mesh.triangles.size()));
    }
}

namespace {

constexpr std::uint32_t not_in_part = 0xffffffff;

/// Returns the new index of each vertex, in the original order.
std::vector<std::uint32_t> numbered(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> numbers(mesh.positions.size(), not_in_part);
    for (const std::uint32_t triangle : triangles) {
        if (triangle >= mesh.triangles.size())
            throw InvalidInput(fmt::format("there is no triangle {}", triangle));
        for (int corner = 0; corner < 3; ++corner)
            numbers[mesh.triangles[triangle][corner]] = 0;
    }
    std::uint32_t next = 0;
    for (std::uint32_t& number : numbers) {
        if (number != not_in_part) number = next++;
    }
    return numbers;
}

template <typename Value>
std::vector<Value> used(const std::vector<Value>& values,
                        const std::vector<std::uint32_t>& numbers) {
    std::vector<Value> result;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (numbers[i] != not_in_part) result.push_back(values[i]);
    }
    return result;
}

/// Returns the material ranges of the triangles, with adjacent equal ranges joined.
std::vector<MaterialRange> ranges_of(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    std::vector<MaterialRange> result;
    if (mesh.material_ranges.empty()) return result;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const auto after =
            std::upper_bound(mesh.material_ranges.begin(), mesh.material_ranges.end(), triangles[i],
                             [](std::uint32_t triangle, const MaterialRange& range) {
                                 return triangle < range.first_triangle + range.triangle_count;
                             });
        if (result.empty() || result.back().material != after->material)
            result.push_back({i, 0, after->material});
        ++result.back().triangle_count;
    }
    return result;
}

}  // namespace

Mesh part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
    validate(mesh);
    const std::vector<std::uint32_t> numbers = numbered(mesh, triangles);
    Mesh part;
    part.name = mesh.name;
    part.positions = used(mesh.positions, numbers);
    part.normals = used(mesh.normals, numbers);
    part.texcoords = used(mesh.texcoords, numbers);
    part.texcoords_2 = used(mesh.texcoords_2, numbers);
    part.tangents = used(mesh.tangents, numbers);
    part.colors = used(mesh.colors, numbers);
    part.triangles.reserve(triangles.size());
    for (const std::uint32_t triangle : triangles) {
        const glm::uvec3 corners = mesh.triangles[triangle];
        part.triangles.emplace_back(numbers[corners.x], numbers[corners.y], numbers[corners.z]);
        if (!mesh.smoothing_groups.empty())
            part.smoothing_groups.push_back(mesh.smoothing_groups[triangle]);
    }
    part.material_ranges = ranges_of(mesh, triangles);
    return part;
}

namespace {

/// Returns the linear part in double precision, scaled so that tiny and huge transforms keep their
/// digits.
glm::dmat3 directions_from(const glm::mat4& matrix) {
    glm::dmat3 linear(matrix);
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(linear[column][row]));
    }
    return largest > 0.0 ? linear / largest : glm::dmat3(1.0);
}

glm::dmat3 normals_from(const glm::dmat3& linear) {
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    return glm::determinant(linear) < 0.0 ? -cofactors : cofactors;
}

glm::vec3 turned(const glm::dmat3& transform, const glm::vec3& direction) {
    const glm::dvec3 result = transform * glm::dvec3(direction);
    const double length = glm::length(result);
    return length > 0.0 ? glm::vec3(result / length) : direction;
}

}  // namespace

Mesh transformed(Mesh mesh, const glm::mat4& world_from_object) {
    const glm::dmat4 matrix(world_from_object);
    const glm::dmat3 tangents = directions_from(world_from_object);
    const glm::dmat3 normals = normals_from(tangents);
    const bool mirrors = glm::determinant(tangents) < 0.0;
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(matrix * glm::dvec4(position, 1.0));
    for (glm::vec3& normal : mesh.normals)
        normal = turned(normals, normal);
    for (glm::vec4& tangent : mesh.tangents) {
        tangent = glm::vec4(turned(tangents, glm::vec3(tangent)), mirrors ? -tangent.w : tangent.w);
    }
    if (mirrors) {
        for (glm::uvec3& triangle : mesh.triangles)
            std::swap(triangle.y, triangle.z);
    }
    return mesh;
}

glm::vec2 transformed(const GltfTextureTransform& transform, const glm::vec2& texcoord) {
    const glm::vec2 scaled = transform.scale * texcoord;
    const auto cosine = static_cast<float>(portable::cos(double{transform.rotation}));
    const auto sine = static_cast<float>(portable::sin(double{transform.rotation}));
    return {cosine * scaled.x + sine * scaled.y + transform.offset.x,
            cosine * scaled.y - sine * scaled.x + transform.offset.y};
}

glm::vec4 transformed(const GltfTextureTransform& transform, const glm::vec4& tangent,
                      const glm::vec3& normal) {
    const glm::dvec2 scale(transform.scale);
    if (scale.x == 0.0 || scale.y == 0.0) return tangent;
    const glm::dvec3 t(tangent);
    const glm::dvec3 b = glm::cross(glm::dvec3(normal), t) * static_cast<double>(tangent.w);
    const auto rotation = static_cast<double>(transform.rotation);
    // The inverse of the transform (with v upwards), applied to the derivatives of position by u
    // and v.
    const glm::dvec3 turned =
        t * (portable::cos(rotation) / scale.x) - b * (portable::sin(rotation) / scale.y);
    const double length = glm::length(turned);
    if (!(length > 0.0) || !std::isfinite(length)) return tangent;
    return {glm::vec3(turned / length),
            (scale.x < 0.0) == (scale.y < 0.0) ? tangent.w : -tangent.w};
}

}  // namespace relief
