// SPDX-License-Identifier: Apache-2.0
/// \file
/// Polygons over indexed vertices, as files hold them, to triangles.
/// Tests: tests/mesh/io/mesh/mesh_file_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

/// Polygons as runs of vertex indices.
struct Polygons {
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> corner_counts;
};

/// Triangles, and the polygon that each is a part of.
struct CutPolygons {
    std::vector<glm::uvec3> triangles;
    std::vector<std::uint32_t> polygons;
};

/// Cuts polygons by the rule of polygon_triangulation.h.
///
/// \param vertices  positions and, where it has them, texture coordinates
/// \param report    counts polygons of fewer than three corners (left out) and those that no ear
///                  cut fits (cut as fans)
CutPolygons cut_polygons(const Mesh& vertices, const Polygons& polygons, Report& report);

/// Fills in a mesh's triangles. \throws FileError if a polygon names a vertex that does not exist,
/// or no triangle comes out
void add_triangles(Mesh& mesh, const Polygons& polygons, const std::filesystem::path& file,
                   Report& report);

}  // namespace relief
