// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes of surfaces whose normals are known in closed form: the ground truth that methods are
/// measured against. Tests: tests/mesh/accuracy/analytic_surfaces_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief {

enum class AnalyticSurface {
    sphere,     ///< Radius 1; its two poles are left open.
    torus,      ///< Radii 1 and 0.4.
    ellipsoid,  ///< Half axes 1, 0.7 and 0.4; poles left open.
    saddle,     ///< z = 0.5 (x^2 - y^2) over [-1,1]^2.
    cubic,      ///< z = a cubic in x and y, its coefficients drawn at random, over [-1,1]^2.
};

/// How the surface's two parameters are cut into triangles. Two to a cell, each cell along one of
/// its diagonals, drawn at random where points are.
enum class Triangulation {
    regular,      ///< A square grid.
    jittered,     ///< Its points moved at random, by up to 0.24 of a cell: none turns over.
    anisotropic,  ///< Jittered, cells 16 times as long as wide.
    folded,       ///< Moved by up to 0.6 of a cell, so that some triangles are turned over.
};

/// A mesh with the truth about it.
struct AnalyticMesh {
    Mesh mesh;                         ///< Positions and triangles; no vertex is there twice.
    std::vector<glm::dvec3> normals;   ///< At the positions before they were rounded; unit.
    std::vector<unsigned char> inner;  ///< 1 for vertices with triangles all around, else 0.
};

/// \param cells  along each parameter, at least 4; for anisotropic cells 4 times as many one way
/// and
///               4 times fewer the other
/// \param seed   of what is drawn at random: same seed, same mesh, on every machine
AnalyticMesh analytic_mesh(AnalyticSurface surface, Triangulation triangulation, int cells,
                           std::uint32_t seed);

/// The experiment of [Max 1999]: a vertex on a surface z = a cubic through the origin, with
/// `valence` neighbours on it at random directions and distances, closed to a fan. The truth is
/// (0,0,1).
Mesh cubic_fan(int valence, std::uint32_t seed);

}  // namespace relief
