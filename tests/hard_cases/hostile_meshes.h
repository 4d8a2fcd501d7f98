// SPDX-License-Identifier: Apache-2.0
/// \file
/// Small meshes drawn at random from what breaks naive code, all of it at once.
#pragma once

#include <cstdint>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// A valid mesh (mesh.h) of at most 12 vertices and 24 triangles with normals and texture
/// coordinates, the same for the same seed on every machine.
///
/// Vertices repeat each other in part or whole; values are common, huge, tiny, denormal, negative
/// zeros, NaN or infinite; triangles repeat, collapse and share edges any number of times; normals
/// are of any length, or none; texture coordinates fold, coincide or lie on a line.
Mesh hostile_mesh(std::uint32_t seed);

}  // namespace relief::test
