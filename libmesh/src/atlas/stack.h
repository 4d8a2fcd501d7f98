// SPDX-License-Identifier: Apache-2.0
/// \file
/// Equal parts of a mesh that share their texels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "atlas/surface.h"
#include "relief/mesh/unwrap.h"

namespace relief::detail {

/// The parts of a surface (faces that are joined across edges) that are equal to an earlier one up
/// to a rotation and a shift.
struct EqualParts {
    /// For each corner of a face, the corner of the first equal part, or itself.
    std::vector<Corner> source;
    std::size_t count = 0;  ///< Parts that have another source.
};

/// \param kind  of each face: faces of different kinds are not equal
EqualParts equal_parts(const AtlasSurface& surface, std::span<const std::uint32_t> kind);

/// Unwraps one of several equal parts, and gives its coordinates to the others.
Unwrapped stacked(const Mesh& mesh, UnwrapOptions options, Report& report);

}  // namespace relief::detail
