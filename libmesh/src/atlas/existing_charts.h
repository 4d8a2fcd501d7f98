// SPDX-License-Identifier: Apache-2.0
/// \file
/// The charts of existing texture coordinates, to be packed anew.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "atlas/flat_charts.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// Returns the sets of faces that are connected by joined edges; each is ascending.
std::vector<std::vector<std::uint32_t>> connected_faces(const AtlasSurface& surface);

/// Returns the charts of a mesh with the shapes and the relative sizes that they have in a map with
/// the proportions of `size`.
///
/// \param surface  of the mesh, with borders at its seams (AtlasConstraints::at_seams)
/// \param unmirror  reflects mirrored charts
/// \param report  counts mirrored charts
/// \throws InvalidInput if there are no texture coordinates, one is not finite, or the charts have
///         no area
std::vector<FlatChart> existing_charts(const AtlasSurface& surface, const Mesh& mesh,
                                       const glm::ivec2& size, bool unmirror, Report& report);

}  // namespace relief::detail
