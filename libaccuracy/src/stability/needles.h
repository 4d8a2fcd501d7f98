// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles as narrow as floats allow, each alone, whose normals are known without subtracting
/// what is nearly equal. Tests: tests/accuracy/needles_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief {

struct Needles {
    Mesh mesh;                        ///< Positions and triangles; no two share a vertex.
    std::vector<glm::dvec3> normals;  ///< Of each vertex; unit.
};

/// \param width  of the short side, which is across the long ones. Two corners lie within twice
///               that of the origin, where floats are fine enough for any width, the third at a
///               distance of 1; every third needle begins with each corner.
Needles make_needles(std::size_t count, double width, std::uint32_t seed);

}  // namespace relief
