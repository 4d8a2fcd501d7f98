// SPDX-License-Identifier: Apache-2.0
/// \file
/// New texture coordinates of a mesh, given for the corners of its triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "relief/export.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"

namespace RELIEF_API relief {
namespace detail {

/// Replaces the texture coordinates of a mesh. Vertices are split where their corners differ; all
/// other attributes are carried along.
/// \param texcoords  three for each triangle, in corner order
/// \throws InvalidInput if there is another number of them
FramedMesh with_corner_texcoords(const Mesh& mesh, std::span<const glm::vec2> texcoords);

}  // namespace detail
}  // namespace relief
