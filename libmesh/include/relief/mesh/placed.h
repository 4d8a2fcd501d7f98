// SPDX-License-Identifier: Apache-2.0
/// \file
/// A mesh moved into another space. Tests: tests/mesh/geometry/placed_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/mesh.h"

namespace relief {

/// The mesh with positions, normals and tangents as a transform makes them.
///
/// \param world_from_object  affine; computed in double
/// \return normals turned by the inverse transpose, and unit again; tangents by the transform
///         itself, unit, without being made perpendicular anew (shears leave them leaning). Where
///         the transform mirrors, triangles are turned round, so that they stay counter-clockwise,
///         and the w of tangents changes its sign, so that bitangents still point upwards in the
///         image. A direction that the transform makes zero stays as it was, so that none is lost
Mesh placed(Mesh mesh, const glm::mat4& world_from_object);

}  // namespace relief
