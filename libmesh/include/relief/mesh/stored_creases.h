// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which edges of a mesh are hard by the normals that it has, and the angle that says so best.
/// Tests: tests/mesh/geometry/normals/stored_creases_test.cpp.
#pragma once

#include <cstddef>
#include <numbers>

#include "relief/mesh/mesh.h"

namespace relief {

struct StoredCreases {
    std::size_t edges = 0;  ///< Between two triangles that both have an area.
    std::size_t hard = 0;   ///< Of them: the two have different normals at one of its ends.
    /// Radians: by it, as HardEdges::crease_angle, the fewest edges are misjudged; pi where none is
    /// hard. Halfway between the edges around it.
    double crease_angle = std::numbers::pi;
    std::size_t misjudged = 0;  ///< By that angle.
};

/// \param mesh  with normals; vertices at equal positions are one, and normals less than half a
///              degree apart
/// \throws InvalidInput if the mesh is not valid or has no normals
StoredCreases stored_creases(const Mesh& mesh);

}  // namespace relief
