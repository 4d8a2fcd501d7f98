// SPDX-License-Identifier: Apache-2.0
/// \file
/// The mesh that geometry is timed on: a sphere with waves, a texture seam and poles, as scans and
/// sculpts have them; vertices in scan-line order.
#pragma once

#include "relief/mesh/mesh.h"

namespace relief::bench {

/// About `triangles` triangles; normals are those of the round sphere, good enough to time with.
Mesh bumpy_sphere(std::size_t triangles);

}  // namespace relief::bench
