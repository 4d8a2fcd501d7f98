// SPDX-License-Identifier: Apache-2.0
/// \file
/// How the texture lies on each triangle: the direction in which u grows, and whether it is
/// mirrored.
///
/// Object space; unit vectors. Computed in double from float input, so that neither the scale nor
/// the offset of positions or texture coordinates matters beyond what their floats can hold.
/// Source: [Mikkelsen 2008]. Tests: tests/mesh/geometry/tangents_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief {

/// What a triangle can say about tangents.
enum class Gradient : std::uint8_t {
    upright,     ///< Counter-clockwise in the upright image as it is in space.
    mirrored,    ///< The other way round.
    none,        ///< Equal or collinear texture coordinates or positions: joins any group.
    coinciding,  ///< Corners at the same place: takes no part at all.
    non_finite,  ///< A position or texture coordinate that is not finite: takes no part at all.
};

inline bool has_gradient(Gradient gradient) {
    return gradient == Gradient::upright || gradient == Gradient::mirrored;
}

inline bool takes_part(Gradient gradient) {
    return gradient <= Gradient::none;
}

struct TriangleGradients {
    std::vector<Gradient> kinds;
    std::vector<glm::vec3> along_u;  ///< Unit, in the triangle's plane; zero where there is none.
    std::vector<glm::vec3> along_v;  ///< The same for v, upwards in the image.
};

/// \param texcoords  upper left origin, v down; the gradient is that of the upright image, v up
/// \param triangles  over welded vertices (weld.h)
///
/// Edges are taken from a triangle's first corner, as the reference implementation does: rotating
/// the corners of a triangle changes the last bits.
TriangleGradients triangle_gradients(std::span<const glm::vec3> positions,
                                     std::span<const glm::vec2> texcoords,
                                     std::span<const glm::uvec3> triangles);

}  // namespace relief
