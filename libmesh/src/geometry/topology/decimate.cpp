// SPDX-License-Identifier: Apache-2.0
// Decimation of a mesh: its vertices become wedges of a surface (topology.h), triangles are taken
// out of that (topology_decimation.h), and what is left is gathered. Positions are scaled into
// [-1, 1] by a power of two for it, so that any unit of length gives the same triangles.
// Tests: tests/mesh/geometry/topology/decimate_test.cpp.
#include "relief/mesh/decimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/direction.h"
#include "geometry/topology/topology.h"
#include "geometry/topology/topology_decimation.h"
#include "geometry/weld.h"
#include "relief/mesh/error.h"
#include "relief/mesh/split.h"

namespace relief {
namespace {

void check(const Mesh& mesh, const DecimateOptions& options) {
    validate(mesh);
    if (!options.triangles && !options.max_error)
        throw InvalidInput("decimation needs a number of triangles or an error to stop at");
    if (options.triangles && *options.triangles == 0)
        throw InvalidInput("0 triangles are no surface; at least 1 must be left");
    if (options.max_error && !(*options.max_error >= 0.0 && std::isfinite(*options.max_error)))
        throw InvalidInput(fmt::format("an error of {} is no distance", *options.max_error));
}

/// From object space into [-1, 1], and how much longer things are there.
struct UnitSpace {
    glm::dvec3 center{0.0};
    double scale = 1.0;

    [[nodiscard]] glm::dvec3 operator()(const glm::vec3& position) const {
        return (glm::dvec3(position) - center) * scale;
    }
};

UnitSpace unit_space(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    UnitSpace space;
    if (bounds.empty()) return space;
    const glm::dvec3 low(bounds.min);
    const glm::dvec3 high(bounds.max);
    space.center = (low + high) / 2.0;
    const glm::dvec3 half = (high - low) / 2.0;
    const double longest = std::max({half.x, half.y, half.z});
    if (longest > 0.0) space.scale = std::ldexp(1.0, -(std::ilogb(longest) + 1));
    return space;
}

/// The number of the material range of each triangle of the mesh.
std::vector<std::uint32_t> parts_of(const Mesh& mesh) {
    std::vector<std::uint32_t> parts(mesh.triangles.size(), 0);
    for (std::uint32_t r = 0; r < mesh.material_ranges.size(); ++r) {
        const MaterialRange& range = mesh.material_ranges[r];
        std::fill_n(parts.begin() + range.first_triangle, range.triangle_count, r);
    }
    return parts;
}

/// For each vertex, the first that is at its position and equal to it in what makes seams. What
/// belongs to different parts stays apart even where it is equal.
std::vector<std::uint32_t> wedges_of(const Mesh& mesh, std::span<const std::uint32_t> classes,
                                     std::span<const std::uint32_t> parts, bool with_normals) {
    std::vector<std::uint32_t> part_of(classes.size(), 0);
    for (std::size_t t = 0; t < parts.size(); ++t) {
        for (int i = 0; i < 3; ++i)
            part_of[mesh.triangles[t][i]] = parts[t];
    }
    const auto is_equal = [&](std::uint32_t a, std::uint32_t b) {
        return part_of[a] == part_of[b] &&
               (mesh.texcoords.empty() || mesh.texcoords[a] == mesh.texcoords[b]) &&
               (mesh.colors.empty() || mesh.colors[a] == mesh.colors[b]) &&
               (!with_normals || mesh.normals.empty() || mesh.normals[a] == mesh.normals[b]);
    };
    // The wedges of each position form a list that starts at its first vertex.
    constexpr std::uint32_t none = no_corner;
    std::vector<std::uint32_t> wedges(classes.size());
    std::vector<std::uint32_t> next(classes.size(), none);
    for (std::uint32_t v = 0; v < classes.size(); ++v) {
        std::uint32_t candidate = classes[v];
        while (candidate != v && !is_equal(candidate, v)) {
            if (next[candidate] == none) next[candidate] = v;
            candidate = next[candidate];
        }
        wedges[v] = candidate;
    }
    return wedges;
}

/// The triangles that are left, each in the place of the one it was.
struct Remains {
    std::vector<std::optional<glm::uvec3>> triangles;  ///< By triangle of the input.
    std::size_t count = 0;
};

Remains remains_of(const Mesh& mesh, const DecimateOptions& options, Report& report) {
    const std::vector<std::uint32_t> classes = weld_positions(mesh.positions);
    const Topology topology = topology_of(mesh, classes, report);
    const std::vector<std::uint32_t> all_parts = parts_of(mesh);
    const std::vector<std::uint32_t> wedges =
        wedges_of(mesh, classes, all_parts, options.frames.normals == NormalMode::keep);
    const UnitSpace space = unit_space(mesh);

    std::vector<glm::dvec3> points;
    for (const std::uint32_t vertex : topology.position_vertex)
        points.push_back(space(mesh.positions[vertex]));
    std::vector<glm::uvec3> corners;
    std::vector<std::uint32_t> parts;
    for (const std::uint32_t source : topology.source_triangle) {
        const glm::uvec3& triangle = mesh.triangles[source];
        corners.emplace_back(wedges[triangle.x], wedges[triangle.y], wedges[triangle.z]);
        parts.push_back(all_parts[source]);
    }

    Decimation decimation{topology, points, corners, parts, mesh.texcoords, {}, {}};
    const std::size_t aside = topology.set_aside.size();
    if (options.triangles)
        decimation.triangles = *options.triangles - std::min(*options.triangles, aside);
    if (options.max_error) decimation.max_error = *options.max_error * space.scale;

    Remains remains{std::vector<std::optional<glm::uvec3>>(mesh.triangles.size()), aside};
    const std::vector<std::optional<glm::uvec3>> left = decimated_wedges(decimation);
    for (std::size_t t = 0; t < left.size(); ++t) {
        remains.triangles[topology.source_triangle[t]] = left[t];
        if (left[t]) ++remains.count;
    }
    for (const std::uint32_t t : topology.set_aside)
        remains.triangles[t] = mesh.triangles[t];
    return remains;
}

/// The vertices that the remaining triangles use, in their order; isolated ones are counted.
std::vector<std::uint32_t> used_vertices(const Mesh& mesh, const Remains& remains, Report& report) {
    std::vector<bool> was_used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            was_used[triangle[i]] = true;
    }
    std::vector<bool> is_used(mesh.positions.size(), false);
    for (const auto& triangle : remains.triangles) {
        if (!triangle) continue;
        for (int i = 0; i < 3; ++i)
            is_used[(*triangle)[i]] = true;
    }
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (!was_used[v]) report.add("isolated vertex", "vertex", v, "is left out");
        if (is_used[v]) vertices.push_back(v);
    }
    return vertices;
}

FramedMesh gathered(const Mesh& mesh, const Remains& remains, Report& report) {
    VertexSplit left{used_vertices(mesh, remains, report), {}};
    std::vector<std::uint32_t> place(mesh.positions.size(), 0);
    for (std::uint32_t i = 0; i < left.source_vertex.size(); ++i)
        place[left.source_vertex[i]] = i;
    std::vector<MaterialRange> ranges = mesh.material_ranges;
    std::vector<std::uint32_t> groups;
    const std::vector<std::uint32_t> parts = parts_of(mesh);
    for (MaterialRange& range : ranges)
        range.triangle_count = 0;
    for (std::size_t t = 0; t < remains.triangles.size(); ++t) {
        const auto& triangle = remains.triangles[t];
        if (!triangle) continue;
        left.triangles.emplace_back(place[triangle->x], place[triangle->y], place[triangle->z]);
        if (!mesh.smoothing_groups.empty()) groups.push_back(mesh.smoothing_groups[t]);
        if (!ranges.empty()) ++ranges[parts[t]].triangle_count;
    }
    std::uint32_t first = 0;
    for (MaterialRange& range : ranges) {
        range.first_triangle = first;
        first += range.triangle_count;
    }
    FramedMesh result;
    result.mesh = carried(mesh, left);
    result.mesh.tangents.clear();  // Of other triangles.
    result.mesh.material_ranges = std::move(ranges);
    result.mesh.smoothing_groups = std::move(groups);
    result.source_vertex = std::move(left.source_vertex);
    return result;
}

/// Normals and tangents as asked for; nothing where nothing is asked and nothing was there.
FramedMesh framed(const Mesh& input, FramedMesh small, FrameOptions frames, Report& report) {
    const bool had_tangents = !input.tangents.empty() && !input.texcoords.empty();
    if (frames.tangents == TangentMode::keep) {
        frames.tangents = had_tangents ? TangentMode::mikktspace : TangentMode::none;
        if (!input.tangents.empty()) {
            report.add("tangents of other triangles", "mesh", 0,
                       had_tangents ? "are computed anew"
                                    : "are removed: there are no texture coordinates");
        }
    }
    if (frames.normals == NormalMode::keep && frames.tangents == TangentMode::none) return small;
    FramedMesh result = with_frames(std::move(small.mesh), frames, report);
    for (std::uint32_t& source : result.source_vertex)
        source = small.source_vertex[source];
    return result;
}

}  // namespace

FramedMesh decimated(const Mesh& mesh, const DecimateOptions& options, Report& report) {
    check(mesh, options);
    const Remains remains = remains_of(mesh, options, report);
    // One interior move takes two triangles, so the number may be missed by one.
    if (options.triangles && !options.max_error && remains.count > *options.triangles) {
        report.add("number of triangles out of reach", "mesh", 0,
                   fmt::format("{} are left: seams, hard edges, borders and shape allow no fewer",
                               remains.count));
    }
    return framed(mesh, gathered(mesh, remains, report), options.frames, report);
}

}  // namespace relief
