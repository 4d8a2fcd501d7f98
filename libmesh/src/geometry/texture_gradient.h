// SPDX-License-Identifier: Apache-2.0
/// \file
/// Texture gradient of a triangle: the directions of increasing u and v, and whether the texture is
/// mirrored.
///
/// Object space. Edges are floats, as in the reference implementation, multiplied by a power of
/// two, so that neither the scale nor the offset of positions or texture coordinates matters beyond
/// the precision of their floats. Source: [Mikkelsen 2008].
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "portable_math.h"
#include "relief/mesh/buffers.h"

namespace relief::detail {

/// Kinds of triangles with respect to tangents.
enum class Gradient : std::uint8_t {
    upright,     ///< Same orientation in the image (v upwards) as in space.
    mirrored,    ///< Opposite orientation.
    none,        ///< Equal or collinear texture coordinates or positions: joins any group.
    coinciding,  ///< Two corners at one position: does not participate.
    non_finite,  ///< A position or texture coordinate is not finite: does not participate.
};

inline bool has_gradient(Gradient gradient) {
    return gradient == Gradient::upright || gradient == Gradient::mirrored;
}

inline bool takes_part(Gradient gradient) {
    return gradient <= Gradient::none;
}

/// The directions of increasing u and v (up) on one triangle: the gradients times `area`, which is
/// twice the triangle's area in the image, negative if mirrored.
struct TextureAxes {
    std::array<float, 3> u;
    std::array<float, 3> v;
    float area;
};

/// \param d1,d2  edges from the first corner to the second and third, in object space
/// \param s1,s2  the same edges in the image, v up
///
/// The arithmetic is in float, with the operations of the reference implementation in their order:
/// on slivers, the rounding of float determines the result. The sign of the area is nevertheless
/// exact, because rounding preserves the order of the two products; it is 0 if they round to the
/// same number.
RELIEF_INLINE TextureAxes texture_axes(const std::array<float, 3>& d1,
                                       const std::array<float, 3>& d2,
                                       const std::array<float, 2>& s1,
                                       const std::array<float, 2>& s2) {
    TextureAxes axes;
    axes.area = s1[0] * s2[1] - s1[1] * s2[0];
    axes.u = {s2[1] * d1[0] - s1[1] * d2[0],  // [Mikkelsen 2008] eq. 18
              s2[1] * d1[1] - s1[1] * d2[1], s2[1] * d1[2] - s1[1] * d2[2]};
    axes.v = {-s2[0] * d1[0] + s1[0] * d2[0],  // [Mikkelsen 2008] eq. 19
              -s2[0] * d1[1] + s1[0] * d2[1], -s2[0] * d1[2] + s1[0] * d2[2]};
    return axes;
}

/// The texture gradient of one triangle.
struct TriangleGradient {
    Gradient kind = Gradient::none;
    glm::vec3 along_u{0.0F};  ///< Unit, in the triangle's plane; zero if undefined.
    glm::vec3 along_v{0.0F};  ///< The same for v, upwards in the image.
    double stretch = 0.0;     ///< Length in space of a unit of u.
};

/// \param texcoords  origin at the upper left, v down; the gradient is that of the upright image, v
///                   up
///
/// Edges start at the triangle's first corner, as in the reference implementation: rotating the
/// corners changes the last bits.
TriangleGradient triangle_gradient(StridedSpan<const glm::vec3> positions,
                                   StridedSpan<const glm::vec2> texcoords,
                                   const glm::uvec3& triangle);

/// Returns only the kinds, of all triangles.
std::vector<Gradient> gradient_kinds(StridedSpan<const glm::vec3> positions,
                                     StridedSpan<const glm::vec2> texcoords,
                                     TriangleSpan triangles);

}  // namespace relief::detail
