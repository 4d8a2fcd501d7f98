// SPDX-License-Identifier: Apache-2.0
/// \file
/// Transforms meshes.
/// Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/mesh.h"

namespace relief {

/// Transforms the positions, normals and tangents of a mesh.
///
/// \param world_from_object  affine; computed in double precision
/// \return a mesh whose normals are transformed by the inverse transpose and normalized, and whose
///         tangents are transformed and normalized, but not made perpendicular again (after a shear
///         they lean). If the transform mirrors, the winding of triangles is reversed, so that they
///         stay counter-clockwise, and the w of tangents is negated, so that bitangents still point
///         up in the image. A direction that would become zero does not change
Mesh placed(Mesh mesh, const glm::mat4& world_from_object);

}  // namespace relief
