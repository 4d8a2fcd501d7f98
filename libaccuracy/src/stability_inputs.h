// SPDX-License-Identifier: Apache-2.0
/// \file
/// Hard inputs of the stability experiments (degenerate triangles, needles), and textbook code
/// without guards, which is measured for contrast with the library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// Kinds of triangles that a mesh can have without a change of its surface.
enum class HardTriangle {
    collapsed,   ///< Refers to one vertex twice.
    coinciding,  ///< Has two corners at the same position.
    needle,      ///< Has its third corner at the middle of an edge, up to rounding.
    nowhere,     ///< Has a corner that is not a number.
    back,        ///< Lies on another triangle with the opposite orientation.
};

struct HardTriangleName {
    HardTriangle kind;
    const char* id;
    const char* title;
};
inline constexpr std::array hard_triangle_names = {
    HardTriangleName{HardTriangle::collapsed, "collapsed",
                     "Triangles that refer to a vertex twice"},
    HardTriangleName{HardTriangle::coinciding, "coinciding",
                     "Triangles with two corners at the same position"},
    HardTriangleName{HardTriangle::needle, "needle", "Needles along an edge"},
    HardTriangleName{HardTriangle::nowhere, "nowhere", "Triangles with a corner that is NaN"},
    HardTriangleName{HardTriangle::back, "back", "Triangles with another one on their back side"},
};

/// Adds `count` hard triangles, spread evenly over the mesh; with HardTriangle::back at most one
/// per triangle. The vertices and triangles of the mesh keep their indices. The result has only
/// positions and triangles.
Mesh with_hard_triangles(const Mesh& mesh, HardTriangle kind, std::size_t count);

/// Separate needle-shaped triangles with their exact normals.
struct Needles {
    Mesh mesh;                        ///< Positions and triangles; no two share a vertex.
    std::vector<glm::dvec3> normals;  ///< Per vertex; unit.
};

/// Makes needles without cancellation in their exact normals: two corners lie within twice the
/// width of the origin, where floats are fine enough, and the third corner lies at a distance of 1.
///
/// \param width  length of the short side, which is perpendicular to the long ones. The first
/// corner
///               alternates between the three.
Needles make_needles(std::size_t count, double width, std::uint32_t seed);

/// Textbook code: normalizes the sum of cross products around each vertex; 0 / 0 gives NaN.
std::vector<glm::vec3> textbook_area_normals(const Mesh& mesh);

/// Textbook code: normalizes the sum of unit normals weighted by the arc cosines of corner angles.
std::vector<glm::vec3> textbook_angle_normals(const Mesh& mesh);

/// Textbook code, [Lengyel 2001] as printed: averages tangents over all triangles of a vertex.
/// \return three tangents per triangle
std::vector<glm::vec4> textbook_tangents(const Mesh& mesh);

/// Textbook code: Sobel differences of 3 x 3 heights, then (-dh/dx, -dh/dy, 1) normalized, y up;
/// the border is (0, 0, 1).
/// \param height  one float channel
Image textbook_sobel_normals(const Image& height, float strength);

}  // namespace relief
