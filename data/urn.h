// SPDX-License-Identifier: Apache-2.0
/// \file
/// An urn twice: carved all over, and the same shape in few triangles with texture coordinates that
/// never overlap: a pair to bake. Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include "relief/mesh/mesh.h"

namespace relief::sample {

/// Standing on the origin, y up, 1 unit tall; closed. No normals: they follow from the surface.
Mesh carved_urn();

/// Its body is one chart, the discs below and above are two.
Mesh plain_urn();

}  // namespace relief::sample
