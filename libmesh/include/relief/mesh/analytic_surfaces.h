// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes of surfaces whose normals and tangents are known in closed form: the ground truth that
/// methods are measured against. Tests: tests/mesh/accuracy/analytic_surfaces_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
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

/// How an image lies on a surface, whose first parameter runs from left to right and whose second
/// from bottom to top.
enum class TextureLayout {
    upright,   ///< u is the first parameter, 1 - v the second.
    sheared,   ///< v grows along the first parameter too, half as fast as u.
    mirrored,  ///< Twice, side by side: u grows up to the middle, and then falls.
};

/// The tangent frame of a surface itself.
struct SurfaceFrame {
    glm::dvec3 normal;   ///< Unit.
    glm::dvec3 tangent;  ///< To where u grows and v stays, unit, perpendicular to the normal.
    double handedness;   ///< 1 or -1: times cross(normal, tangent), it is on the side of smaller v.
};

/// A textured mesh with the truth about it.
struct TexturedMesh {
    Mesh mesh;  ///< Positions, true normals, texture coordinates and triangles.
    /// Where on the surface each vertex is. Inside of a triangle, they and the texture coordinates
    /// are interpolated alike.
    std::vector<glm::dvec2> parameters;
    std::vector<unsigned char> inner;  ///< 1 for vertices away from borders and seams, else 0.
    /// The truth at parameters inside of a triangle. On the line where an image meets its mirror
    /// image there are two; this is the right-hand one.
    std::function<SurfaceFrame(const glm::dvec2& parameters)> frame_at;
};

/// As analytic_mesh(), but that surfaces which run back into themselves have a seam there: vertices
/// at the same place with different texture coordinates.
///
/// \param cells  even where the layout is mirrored, so that the images meet along edges
TexturedMesh textured_mesh(AnalyticSurface surface, Triangulation triangulation,
                           TextureLayout layout, int cells, std::uint32_t seed);

/// The square [-1,1]^2 facing +z, two triangles, with bevels around it, outwards and down at 45
/// degrees. All normals of the square are (0,0,1), as game models have them; the image lies upright
/// on the square, and goes on over the bevels sheared by 45 degrees.
///
/// \param width  of the bevels, above 0
/// \return the square's vertices are the inner ones; parameters are x and y; the truth is that of
/// the
///         square
TexturedMesh bevelled_plate(double width);

}  // namespace relief
