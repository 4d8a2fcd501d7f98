// SPDX-License-Identifier: Apache-2.0
/// \file
/// Meshes that tangents are timed on, beside the bumpy sphere: a terrain, and shapes on which
/// looking for neighbors, recursion or comparing sets takes quadratic time.
#pragma once

#include <cstddef>

#include "relief/mesh/mesh.h"

namespace relief::bench {

/// A square of hills; its texture is laid on from above. About `triangles` triangles.
Mesh displaced_grid(std::size_t triangles);

/// Triangles around one vertex, closed to a disc.
Mesh fan(std::size_t triangles);

/// Triangles on one edge, as the pages of a book are; half of them each way round.
Mesh book(std::size_t triangles);

/// The grid with all its vertices at one place.
Mesh collapsed_to_a_point(std::size_t triangles);

/// The grid with all its vertices on a line.
Mesh collapsed_to_a_line(std::size_t triangles);

}  // namespace relief::bench
