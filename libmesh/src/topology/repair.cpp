// SPDX-License-Identifier: Apache-2.0
// Repair of a mesh: the steps, and the vertices and triangles of the result.
// Tests: tests/mesh/topology/repair_test.cpp.
#include "relief/mesh/repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geometry/value_order.h"
#include "progress_stage.h"
#include "topology/collapse_input.h"
#include "topology/repair_parts.h"

namespace relief {
using namespace relief::detail;

namespace {

void check_repair(const Mesh& mesh, const RepairOptions& options, const Deformation& deformation) {
    validate(mesh);
    const auto check_count = [&](std::size_t count) {
        if (count != 0 && count != mesh.positions.size())
            throw InvalidInput(fmt::format("there are {} values of a deformation, but {} positions",
                                           count, mesh.positions.size()));
    };
    check_count(deformation.joints.size());
    for (const auto& displacements : deformation.displacements)
        check_count(displacements.size());
    if (!(options.weld_tolerance >= 0.0 && std::isfinite(options.weld_tolerance)))
        throw InvalidInput(fmt::format(
            "the weld tolerance is {}, but must be finite and at least 0", options.weld_tolerance));
    if (options.two_sided == TwoSided::together && !options.orient)
        throw InvalidInput("the sides of a wall stay together only if triangles are oriented");
    if (!(options.drop_parts >= 0.0 && std::isfinite(options.drop_parts)))
        throw InvalidInput(
            fmt::format("the size of parts to drop is {}, but must be finite and at least 0",
                        options.drop_parts));
}

/// Compares the attributes of vertices without their positions.
class VertexOrder {
  public:
    VertexOrder(const Mesh& mesh, const Deformation& deformation)
        : mesh_(mesh), deformation_(deformation) {}

    [[nodiscard]] int compare(std::uint32_t a, std::uint32_t b) const {
        int order = 0;
        const auto add = [&](const auto& values) {
            if (order == 0 && !values.empty()) order = compare_values(values[a], values[b]);
        };
        add(mesh_.normals);
        add(mesh_.texcoords);
        add(mesh_.tangents);
        add(mesh_.colors);
        add(mesh_.texcoords_2);
        add(deformation_.joints);
        for (const auto& displacements : deformation_.displacements)
            add(displacements);
        return order;
    }

  private:
    const Mesh& mesh_;
    const Deformation& deformation_;
};

/// Returns for each vertex the smallest one that is equal to it, and is used in the same material
/// range first.
std::vector<std::uint32_t> merged_vertices(const Mesh& mesh, const Deformation& deformation,
                                           const RepairSurface& surface, Report& report) {
    std::vector<std::uint32_t> range_of(mesh.positions.size(), 0);
    for (std::uint32_t i = 0; i < mesh.material_ranges.size(); ++i) {
        const MaterialRange& range = mesh.material_ranges[i];
        for (std::uint32_t t = 0; t < range.triangle_count; ++t) {
            const glm::uvec3& triangle = mesh.triangles[range.first_triangle + t];
            for (glm::length_t k = 0; k < 3; ++k) {
                if (range_of[triangle[k]] == 0) range_of[triangle[k]] = i + 1;
            }
        }
    }
    std::vector<std::uint32_t> begin(surface.positions.size() + 1, 0);
    for (const std::uint32_t position : surface.position_of) {
        if (position != no_position) ++begin[position + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> vertices(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (surface.position_of[v] != no_position) vertices[next[surface.position_of[v]]++] = v;
    }
    std::vector<std::uint32_t> merged(mesh.positions.size());
    std::iota(merged.begin(), merged.end(), 0U);
    const VertexOrder order(mesh, deformation);
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
        return range_of[a] != range_of[b] ? (range_of[a] < range_of[b] ? -1 : 1)
                                          : order.compare(a, b);
    };
    for (std::size_t p = 0; p < surface.positions.size(); ++p) {
        check_cancelled(p);
        if (begin[p + 1] - begin[p] < 2) continue;
        const std::span<std::uint32_t> here(vertices.data() + begin[p], begin[p + 1] - begin[p]);
        std::sort(here.begin(), here.end(), [&](std::uint32_t a, std::uint32_t b) {
            const int before = compare(a, b);
            return before != 0 ? before < 0 : a < b;
        });
        for (std::size_t i = 1; i < here.size(); ++i) {
            if (compare(here[i - 1], here[i]) == 0) merged[here[i]] = merged[here[i - 1]];
        }
    }
    for (std::uint32_t v = 0; v < merged.size(); ++v) {
        if (merged[v] != v) report.add("equal vertex", "vertex", v, "is merged");
    }
    return merged;
}

/// A vertex of the result.
struct RepairedVertex {
    std::uint32_t source = 0;
    std::uint32_t fan = 0;  ///< no_position for a triangle that is set aside.
    bool is_reversed = false;

    friend auto operator<=>(const RepairedVertex&, const RepairedVertex&) = default;
};

/// Numbers the vertices of the result in the order of their sources; copies follow.
class VertexNumbers {
  public:
    explicit VertexNumbers(std::size_t count) : first_(count), is_used_(count, false) {}

    void add(const RepairedVertex& vertex) {
        if (!is_used_[vertex.source]) {
            is_used_[vertex.source] = true;
            first_[vertex.source] = vertex;
        } else if (vertex < first_[vertex.source]) {
            copies_[first_[vertex.source]] = 0;
            copies_.erase(vertex);
            first_[vertex.source] = vertex;
        } else if (first_[vertex.source] != vertex) {
            copies_[vertex] = 0;
        }
    }
    void number() {
        place_.assign(first_.size(), 0);
        for (std::uint32_t v = 0; v < first_.size(); ++v) {
            if (!is_used_[v]) continue;
            place_[v] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(first_[v]);
        }
        for (auto& [vertex, place] : copies_) {
            place = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(vertex);
        }
    }
    [[nodiscard]] std::uint32_t of(const RepairedVertex& vertex) const {
        return first_[vertex.source] == vertex ? place_[vertex.source] : copies_.at(vertex);
    }

    std::vector<RepairedVertex> vertices;

  private:
    std::vector<RepairedVertex> first_;
    std::vector<bool> is_used_;
    std::vector<std::uint32_t> place_;
    std::map<RepairedVertex, std::uint32_t> copies_;
};

/// A triangle of the result.
struct RepairedTriangle {
    std::uint32_t source = 0;
    std::array<RepairedVertex, 3> corners;
};

/// Returns the corner of a face at a position.
Corner corner_at(const RepairSurface& surface, std::uint32_t face, std::uint32_t position) {
    Corner corner = 3 * face;
    while (surface.position_at(corner) != position)
        ++corner;
    return corner;
}

/// Returns the remaining triangles in the order of the input.
std::vector<RepairedTriangle> remaining_triangles(const Mesh& mesh, const RepairSurface& surface,
                                                  std::span<const std::uint32_t> merged,
                                                  std::span<const std::uint32_t> fans,
                                                  Report& report) {
    std::vector<std::uint32_t> face_of(mesh.triangles.size(), no_position);
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        face_of[surface.faces[face].triangle] = face;
        if (surface.faces[face].has_back()) face_of[surface.faces[face].back] = face;
    }
    std::vector<bool> is_set_aside(mesh.triangles.size(), false);
    for (const std::uint32_t t : surface.set_aside)
        is_set_aside[t] = true;
    std::vector<RepairedTriangle> result;
    result.reserve(surface.faces.size() + surface.set_aside.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        check_cancelled(t);
        if (face_of[t] == no_position && !is_set_aside[t]) continue;
        RepairedTriangle& triangle = result.emplace_back();
        triangle.source = t;
        const glm::uvec3& vertices = mesh.triangles[t];
        if (is_set_aside[t]) {
            for (glm::length_t k = 0; k < 3; ++k) {
                const std::uint32_t position = surface.position_of[vertices[k]];
                triangle.corners[static_cast<std::size_t>(k)] = {merged[vertices[k]], position,
                                                                 false};
            }
            continue;
        }
        const RepairFace& face = surface.faces[face_of[t]];
        const bool is_flipped = surface.is_reversed(face_of[t]);
        const glm::dvec3 a = surface.point(face.positions.x);
        const glm::dvec3 normal =
            glm::cross(surface.point(face.positions.y) - a, surface.point(face.positions.z) - a) *
            (is_flipped ? -1.0 : 1.0);
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = vertices[static_cast<glm::length_t>(k)];
            Corner corner = 3 * face_of[t] + (k + 3 - face.first_corner) % 3;
            if (t == face.back)
                corner = corner_at(surface, face_of[t], surface.position_of[vertex]);
            const bool is_reversed = is_flipped && !mesh.normals.empty() &&
                                     glm::dot(glm::dvec3(mesh.normals[vertex]), normal) < 0.0;
            if (is_reversed)
                report.add("normal at the back of a reversed triangle", "corner", 3 * t + k,
                           "is negated");
            triangle.corners[k] = {merged[vertex], fans[corner], is_reversed};
        }
        if (is_flipped) std::swap(triangle.corners[1], triangle.corners[2]);
    }
    return result;
}

void report_isolated(const Mesh& mesh, Report& report) {
    std::vector<bool> is_used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (glm::length_t k = 0; k < 3; ++k)
            is_used[triangle[k]] = true;
    }
    for (std::uint32_t v = 0; v < is_used.size(); ++v) {
        if (!is_used[v]) report.add("isolated vertex", "vertex", v, "is removed");
    }
}

FramedMesh gathered_repair(const Mesh& mesh, std::span<const RepairedTriangle> triangles,
                           std::span<const glm::vec3> position_of_fan) {
    VertexNumbers numbers(mesh.positions.size());
    for (const RepairedTriangle& triangle : triangles) {
        for (const RepairedVertex& corner : triangle.corners)
            numbers.add(corner);
    }
    numbers.number();
    VertexSplit split;
    for (const RepairedVertex& vertex : numbers.vertices)
        split.source_vertex.push_back(vertex.source);
    std::vector<MaterialRange> ranges = mesh.material_ranges;
    for (MaterialRange& range : ranges)
        range.triangle_count = 0;
    std::vector<std::uint32_t> groups;
    const Parts parts = parts_of(mesh);
    for (const RepairedTriangle& triangle : triangles) {
        split.triangles.emplace_back(numbers.of(triangle.corners[0]),
                                     numbers.of(triangle.corners[1]),
                                     numbers.of(triangle.corners[2]));
        if (!mesh.smoothing_groups.empty())
            groups.push_back(mesh.smoothing_groups[triangle.source]);
        if (!ranges.empty()) ++ranges[parts[triangle.source]].triangle_count;
    }
    std::uint32_t first = 0;
    for (MaterialRange& range : ranges) {
        range.first_triangle = first;
        first += range.triangle_count;
    }
    FramedMesh result;
    result.mesh = carried(mesh, split);
    result.mesh.material_ranges = std::move(ranges);
    result.mesh.smoothing_groups = std::move(groups);
    for (std::size_t v = 0; v < numbers.vertices.size(); ++v) {
        const RepairedVertex& vertex = numbers.vertices[v];
        // A comparison keeps the sign of zeros.
        if (vertex.fan != no_position && result.mesh.positions[v] != position_of_fan[vertex.fan])
            result.mesh.positions[v] = position_of_fan[vertex.fan];
        if (!vertex.is_reversed) continue;
        result.mesh.normals[v] = -result.mesh.normals[v];
        // The bitangent stays.
        if (!result.mesh.tangents.empty()) result.mesh.tangents[v].w *= -1.0F;
    }
    result.source_vertex = std::move(split.source_vertex);
    return result;
}

}  // namespace

FramedMesh repaired(const Mesh& mesh, const RepairOptions& options, Report& report,
                    const Deformation& deformation) {
    check_repair(mesh, options, deformation);
    RepairSurface surface = repair_surface(mesh, options, report);
    std::vector<std::uint32_t> merged(mesh.positions.size());
    if (options.merge_vertices)
        merged = merged_vertices(mesh, deformation, surface, report);
    else
        std::iota(merged.begin(), merged.end(), 0U);
    join_faces(surface, options, report);
    orient_parts(surface, options, report);
    std::vector<glm::vec3> position_of_fan = surface.positions;
    std::vector<std::uint32_t> fans(3 * surface.faces.size());
    if (options.separate)
        fans = separate_fans(surface, position_of_fan, report);
    else
        for (Corner corner = 0; corner < fans.size(); ++corner)
            fans[corner] = surface.position_at(corner);
    report_isolated(mesh, report);
    return gathered_repair(mesh, remaining_triangles(mesh, surface, merged, fans, report),
                           position_of_fan);
}

}  // namespace relief
