// SPDX-License-Identifier: Apache-2.0
/// \file
/// The check that triangles refer to existing vertices, in linear time. It runs before any
/// computation.
#pragma once

#include <cstddef>
#include <optional>

#include "relief/mesh/buffers.h"

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// Returns the first corner (3 per triangle) that refers to a vertex that does not exist.
std::optional<std::size_t> corner_beyond(TriangleSpan triangles, std::size_t vertex_count);

/// \throws InvalidInput if there are too many corners for 32-bit indices, or for the first invalid
///         index: "triangle 7 names vertex 12, but there are only 8", or "vertex 4294967295 (-1 as
///         a signed index)"
void check_triangles(TriangleSpan triangles, std::size_t vertex_count);

}  // namespace detail
}  // namespace relief
