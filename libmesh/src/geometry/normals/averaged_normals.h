// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normals averaged around every vertex, and what there is to report about them: the steps behind
/// the public calls of normals.h. Tests: tests/mesh/geometry/normals/normals_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "geometry/normals/exact_normals.h"
#include "geometry/weld.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"

namespace relief {

/// What a vertex without a direction, and a triangle without one, get.
constexpr glm::vec3 fallback_normal{0.0F, 0.0F, 1.0F};

/// Which vertices share their normal. \throws InvalidInput for a tolerance that is none
Groups sharing_vertices(std::span<const glm::vec3> positions,
                        const std::optional<double>& weld_tolerance);

struct AveragedNormals {
    std::vector<glm::vec3> normals;  ///< The fallback where there is trouble.
    /// Vertices without a direction, ascending, and why.
    std::vector<std::pair<std::uint32_t, PlaceKind>> troubles;
    /// Triangles that are not sound, and some that are, ascending.
    std::vector<std::uint32_t> odd_triangles;
    std::size_t by_area = 0;  ///< See ChosenNormals.
};

/// \param shared  which vertices share a normal; called at the same time as votes are summed
/// \throws InvalidInput if a triangle names a vertex that does not exist
AveragedNormals averaged_normals(std::span<const glm::vec3> positions,
                                 std::span<const glm::uvec3> triangles, NormalWeight weight,
                                 Arithmetic arithmetic, const std::function<Groups()>& shared);

/// The same, by the weighting that suits each vertex.
AveragedNormals averaged_normals_by_choice(std::span<const glm::vec3> positions,
                                           std::span<const glm::uvec3> triangles,
                                           Arithmetic arithmetic, const Groups& shared);

/// Counts triangles without a normal.
void report_triangles(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                      std::span<const std::uint32_t> odd, std::string_view outcome, Report& report);

/// Counts one vertex without a direction.
void report_vertex(PlaceKind kind, std::size_t vertex, Report& report);

}  // namespace relief
