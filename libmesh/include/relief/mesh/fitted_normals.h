// SPDX-License-Identifier: Apache-2.0
/// \file
/// Fits smooth surfaces to the vertices of a mesh, whose normals are a reference for others.
/// Tests: tests/mesh/geometry/fitted_normals_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"

namespace RELIEF_API relief {

/// Reference normals at corners, one for each smooth fan (a vertex, or one side of a hard edge at
/// it).
struct FittedNormals {
    std::vector<std::uint32_t> corners;  ///< 3 * triangle + (0, 1 or 2), ascending.
    std::vector<glm::dvec3> normals;     ///< The normals at these corners; unit, object space.
    std::size_t examined_fans = 0;       ///< Number of examined fans.
    std::size_t fans = 0;                ///< Number of fans of the mesh.
    /// The uncertainty of the reference in degrees: the RMS angle between it and a fit of lower
    /// degree, over all corners. Smaller errors are not significant.
    double reference_degrees = 0.0;
};

struct FitOptions {
    HardEdges hard_edges;         ///< The fitted surfaces end at hard edges.
    std::size_t max_fans = 8192;  ///< Maximum number of examined fans, which are evenly spread.
    /// Fans whose two fits differ by more than this many degrees are omitted, because no smooth
    /// surface fits (noise, an unmarked hard edge, triangles as large as the shape).
    double max_fit_difference = 2.0;
    /// Fans with a triangle that deviates by more than this many degrees from the fit are omitted
    /// too.
    double max_fit_angle = 45.0;
};

/// Fits a polynomial of degree 4 to each vertex and its three rings of neighbors, and returns its
/// normals [Cazals and Pouget 2005]. The second fit has degree 3 and two rings.
///
/// \param mesh  positions and triangles; vertices at equal positions count as one
/// \return no normal for fans with too few neighbors, or whose two fits differ too much
/// \throws InvalidInput if the mesh is not valid
///
/// On a smooth surface the error decreases with the fourth power of the triangle size, that of
/// averaged normals at best with the second power. The fit assumes that the surface passes through
/// the vertices and is smooth between hard edges. It is not a valid reference for meshes whose
/// vertices do not lie on the intended surface, such as control cages of subdivision surfaces and
/// strongly decimated models. Computed in double precision; the same for any number of threads.
FittedNormals fitted_normals(const Mesh& mesh, const FitOptions& options);

}  // namespace relief
