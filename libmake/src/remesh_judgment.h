// SPDX-License-Identifier: Apache-2.0
/// \file
/// Judges whether a mesh is remeshed. Tests: tests/make/remeshing_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "relief/export.h"
#include "relief/make/remeshing.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/remesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/unwrap.h"

namespace RELIEF_API relief {
namespace make::detail {

/// The figures that the stages before the judgment measure.
struct RemeshEvidence {
    double crowded_edges = 0.0;  ///< The share of edges with three or more triangles.
    double excess = 0.0;         ///< Triangles beyond the target, relative to it.
    double small_charts = 0.0;   ///< Of small_chart_area().
};

/// Returns the share of the edges of a mesh that have three or more triangles. Both sides of a
/// doubled wall count as one.
/// \param repair  the report of the repair of `mesh`; null: it was not repaired
double crowded_edge_share(const Mesh& mesh, const Report* repair);

/// Returns the share of the area in charts below 1/2000 of the whole area.
double small_chart_area(const Mesh& mesh, const Unwrapped& unwrapped);

/// Returns the criteria with their values. The area that is not seen from outside is measured only
/// if the mesh has several parts.
std::vector<RemeshCriterion> remesh_criteria(const Mesh& mesh, const RemeshEvidence& evidence);

/// Computes a closed surface around a mesh, and its distance.
///
/// \param mesh  valid (mesh.h), positions and triangles of finite positions, maybe with materials
/// \param decision  gets the triangles, the cell and the distance
/// \return positions and triangles, with these materials
/// \throws InvalidInput as remeshed()
Mesh closed_surface(const Mesh& mesh, const RemeshOptions& options, RemeshDecision& decision,
                    Report& report);

/// Returns a closed surface if a criterion is exceeded and the surface is near enough.
///
/// \param decision  has the criteria; gets the reason for the result
/// \param report  counts a surface that is kept although a criterion is exceeded
std::optional<Mesh> better_surface(const Mesh& mesh, const RemeshOptions& options,
                                   RemeshDecision& decision, Report& report);

}  // namespace make::detail
}  // namespace relief
