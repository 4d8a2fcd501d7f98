// SPDX-License-Identifier: Apache-2.0
// Polygons over indexed vertices to triangles. An index past the end is a FileError that names the
// face. Tests: tests/mesh/io/mesh/mesh_file_test.cpp.
#include "io/mesh/polygon_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "io/mesh/polygon_triangulation.h"
#include "large_memory.h"
#include "progress_stage.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

void check_indices(const Polygons& polygons, std::size_t vertex_count,
                   const std::filesystem::path& file) {
    std::size_t corner = 0;
    for (std::size_t i = 0; i < polygons.corner_counts.size(); ++i) {
        check_cancelled(i);
        for (const std::size_t end = corner + polygons.corner_counts[i]; corner < end; ++corner) {
            if (polygons.corners[corner] < vertex_count) continue;
            throw FileError(file, fmt::format("face {} names vertex {}, but there are only {}", i,
                                              polygons.corners[corner], vertex_count));
        }
    }
}

bool are_triangles(const Polygons& polygons) {
    return std::all_of(polygons.corner_counts.begin(), polygons.corner_counts.end(),
                       [](std::uint32_t count) { return count == 3; });
}

/// Nothing to cut.
CutPolygons whole_triangles(const Polygons& polygons) {
    CutPolygons result;
    const std::size_t count = polygons.corner_counts.size();
    reserve_to_fill(result.triangles, count);
    for (std::size_t i = 0; i < count; ++i) {
        check_cancelled(i);
        const std::uint32_t* corner = &polygons.corners[3 * i];
        result.triangles.emplace_back(corner[0], corner[1], corner[2]);
    }
    result.polygons.resize(count);
    std::iota(result.polygons.begin(), result.polygons.end(), 0U);
    return result;
}

}  // namespace

CutPolygons cut_polygons(const Mesh& vertices, const Polygons& polygons, Report& report) {
    if (are_triangles(polygons)) return whole_triangles(polygons);
    CutPolygons result;
    result.triangles.reserve(polygons.corner_counts.size());
    result.polygons.reserve(polygons.corner_counts.size());
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::uvec3> cuts;
    const std::uint32_t* corner = polygons.corners.data();
    ProgressStage stage("cutting polygons", polygons.corner_counts.size());
    for (std::size_t i = 0; i < polygons.corner_counts.size(); ++i) {
        stage.at(i);
        const std::uint32_t count = polygons.corner_counts[i];
        positions.clear();
        texcoords.clear();
        cuts.clear();
        for (std::uint32_t k = 0; count > 3 && k < count; ++k) {
            positions.push_back(vertices.positions[corner[k]]);
            if (!vertices.texcoords.empty()) texcoords.push_back(vertices.texcoords[corner[k]]);
        }
        if (count < 3) {
            report.add("face of fewer than three corners", "face", i, "left out");
        } else if (count == 3) {
            cuts.emplace_back(0, 1, 2);
        } else if (!triangulate_polygon(positions, texcoords, cuts)) {
            report.add("polygon without an ear", "face", i, "cut as a fan");
        }
        for (const glm::uvec3& cut : cuts) {
            result.triangles.emplace_back(corner[cut.x], corner[cut.y], corner[cut.z]);
            result.polygons.push_back(static_cast<std::uint32_t>(i));
        }
        corner += count;
    }
    return result;
}

void add_triangles(Mesh& mesh, const Polygons& polygons, const std::filesystem::path& file,
                   Report& report) {
    check_indices(polygons, mesh.positions.size(), file);
    mesh.triangles = cut_polygons(mesh, polygons, report).triangles;
    if (mesh.triangles.empty()) throw FileError(file, "has no triangle");
}

}  // namespace relief
