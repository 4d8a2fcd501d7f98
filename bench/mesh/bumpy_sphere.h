// SPDX-License-Identifier: Apache-2.0
/// \file
/// The mesh of most geometry benchmarks: a sphere with waves, a texture seam and poles. The
/// vertices are in scan-line order.
#pragma once

#include "relief/mesh/mesh.h"

namespace relief::bench {

/// A mesh of about `triangles` triangles. The normals are those of the sphere without waves, which
/// is sufficient for timing.
Mesh bumpy_sphere(std::size_t triangles);

}  // namespace relief::bench
