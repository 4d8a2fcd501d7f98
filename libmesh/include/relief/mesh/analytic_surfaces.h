// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generates meshes of surfaces whose normals and tangents are known in closed form. They are the
/// ground truth for the errors of normal and tangent methods.
/// Tests: tests/mesh/accuracy/analytic_surfaces_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/mesh.h"

namespace RELIEF_API relief {

enum class AnalyticSurface {
    sphere,     ///< Radius 1; open at both poles.
    torus,      ///< Radii 1 and 0.4.
    ellipsoid,  ///< Semi-axes 1, 0.7 and 0.4; open at both poles.
    saddle,     ///< z = 0.5 (x^2 - y^2) over [-1,1]^2.
    cubic,      ///< z = a cubic polynomial in x and y with random coefficients, over [-1,1]^2.
};

/// The triangulation of the parameter domain. Each cell has two triangles. The diagonal is random
/// if the points are random.
enum class Triangulation {
    regular,      ///< A square grid.
    jittered,     ///< Random offsets of up to 0.24 cells; no triangle is inverted.
    anisotropic,  ///< Jittered; cells are 16 times as long as wide.
    folded,       ///< Random offsets of up to 0.6 cells; some triangles are inverted.
};

/// A mesh and its exact normals.
struct AnalyticMesh {
    Mesh mesh;                        ///< Positions and triangles, without duplicate vertices.
    std::vector<glm::dvec3> normals;  ///< Unit; at the positions before rounding to float.
    /// 1 for vertices that triangles surround completely, else 0.
    std::vector<unsigned char> inner;
};

/// Triangulates a surface.
///
/// \param cells  along each parameter, at least 4; anisotropic meshes have 4 times as many along
///         one parameter and a quarter along the other
/// \param seed  of all random numbers; the same seed gives the same mesh on every machine
AnalyticMesh analytic_mesh(AnalyticSurface surface, Triangulation triangulation, int cells,
                           std::uint32_t seed);

/// Creates the experiment of [Max 1999]: a closed fan around a vertex at the origin of a cubic
/// surface z(x, y), with `valence` neighbors on the surface at random directions and distances. The
/// exact normal of the vertex is (0,0,1).
Mesh cubic_fan(int valence, std::uint32_t seed);

/// The mapping of an image onto a surface. The first parameter runs from left to right, the second
/// one from bottom to top.
enum class TextureLayout {
    upright,   ///< u is the first parameter, v is 1 minus the second one.
    sheared,   ///< v also increases along the first parameter, half as fast as u.
    mirrored,  ///< Two copies side by side: u increases up to the middle and then decreases.
};

/// The tangent frame of the exact surface.
struct SurfaceFrame {
    glm::dvec3 normal;   ///< Unit.
    glm::dvec3 tangent;  ///< Unit, perpendicular to the normal; u increases along it at constant v.
    double handedness;   ///< 1 or -1; its product with cross(normal, tangent) points towards
                         ///< decreasing v.
};

/// A textured mesh and the exact frames of its surface.
struct TexturedMesh {
    Mesh mesh;  ///< Positions, exact normals, texture coordinates and triangles.
    /// The surface parameters of each vertex. Inside of a triangle, interpolate them in the same
    /// way as the texture coordinates.
    std::vector<glm::dvec2> parameters;
    std::vector<unsigned char> inner;  ///< 1 for vertices away from borders and seams, else 0.
    /// Returns the exact frame at parameters inside of a triangle. On the line between an image and
    /// its mirror image, this is the frame of the right side.
    std::function<SurfaceFrame(const glm::dvec2& parameters)> frame_at;
};

/// Like analytic_mesh(), with texture coordinates. Closed surfaces have a seam: vertices at the
/// same position with different texture coordinates.
///
/// \param cells  as in analytic_mesh(); even for TextureLayout::mirrored, so that the images meet
///         along edges
TexturedMesh textured_mesh(AnalyticSurface surface, Triangulation triangulation,
                           TextureLayout layout, int cells, std::uint32_t seed);

/// Creates the square [-1,1]^2 that faces +z, as two triangles, with bevels around it that slope
/// down at 45 degrees. All normals of the square are (0,0,1), as in game models. The image is
/// upright on the square and continues over the bevels with a shear of 45 degrees.
///
/// \param width  of the bevels, above 0
/// \return a mesh in which the vertices of the square are the inner ones, the parameters are x and
///         y, and the exact frames are those of the square
TexturedMesh beveled_plate(double width);

}  // namespace relief
