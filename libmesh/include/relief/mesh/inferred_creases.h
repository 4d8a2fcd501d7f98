// SPDX-License-Identifier: Apache-2.0
/// \file
/// Infers the hard edges of a mesh from its normals, and the crease angle that best separates them
/// from smooth edges.
/// Tests: tests/mesh/geometry/corner_normals_test.cpp.
#pragma once

#include <cstddef>
#include <numbers>

#include "relief/mesh/mesh.h"

namespace relief {

struct InferredCreases {
    std::size_t edges = 0;  ///< Number of edges between two triangles with area.
    /// Number of these edges with different normals of the two triangles at one of its ends.
    std::size_t hard = 0;
    /// The crease angle in radians, as HardEdges::crease_angle, with the fewest misclassified
    /// edges, halfway between the angles of the two closest edges; pi if no edge is hard.
    double crease_angle = std::numbers::pi;
    std::size_t misclassified = 0;  ///< Number of edges that this angle misclassifies.
};

/// Infers the hard edges of a mesh.
///
/// \param mesh  with normals; vertices at equal positions count as one, and normals that differ by
///         less than half a degree as equal
/// \throws InvalidInput if the mesh is not valid or has no normals
InferredCreases inferred_creases(const Mesh& mesh);

}  // namespace relief
