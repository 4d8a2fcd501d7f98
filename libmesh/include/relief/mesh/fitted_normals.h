// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normals of the smooth surface that a mesh of any origin was most likely made from: the truth
/// where there is no formula. Tests: tests/mesh/accuracy/fitted_normals_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"

namespace relief {

/// The truth at corners, one for each smooth fan (a vertex, or a side of a hard edge at it).
struct FittedNormals {
    std::vector<std::uint32_t> corners;  ///< 3 * triangle + (0, 1 or 2), ascending.
    std::vector<glm::dvec3> normals;     ///< Of those corners; unit, object space.
    std::size_t places = 0;              ///< Fans that were looked at.
    std::size_t fans = 0;                ///< That the mesh has.
    /// What the truth is not known better than, degrees: RMS over the corners of how far a cruder
    /// fit is off it. Errors below this say nothing.
    double own_degrees = 0.0;
};

struct FitOptions {
    HardEdges hard_edges;            ///< Surfaces end there.
    std::size_t most_places = 8192;  ///< Of more fans, so many are looked at, evenly spread.
    /// Where the two fits are further apart there is no smooth surface to speak of (noise, an edge
    /// that is not marked as hard, cells as large as the shape), and the place is left out.
    double most_doubt = 2.0;
    /// Nor is there where a triangle at the vertex is turned further than this from the fit.
    double most_bend = 45.0;
};

/// Fits a polynomial of degree 4 through each vertex and those of three rings of triangles around
/// it, and takes its normal [Cazals and Pouget 2005]; the cruder fit is of degree 3, two rings.
///
/// \param mesh  positions and triangles; vertices at equal positions are one
/// \return nothing at fans with too few vertices around them, or whose fits are too far apart
/// \throws InvalidInput if the mesh is not valid
///
/// On a smooth surface the error falls with the fourth power of the size of triangles, that of any
/// averaged normals with the second at best. It knows the vertices alone: that the surface goes
/// through them, and is smooth between hard edges. A mesh whose vertices are no part of what it
/// stands for (a cage for subdivision, a model decimated past recognition) is not judged by it.
/// In double; the same for any number of threads.
FittedNormals fitted_normals(const Mesh& mesh, const FitOptions& options);

}  // namespace relief
