// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normals at single places in higher precision and a fixed order: where quick sums leave it open
/// how they round (normal_rounding.h), and where there is no direction to be had.
/// Tests: tests/mesh/geometry/normals/normals_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/normals/normal_sums.h"
#include "relief/mesh/normals.h"

namespace relief {

enum class PlaceKind : std::uint8_t {
    sound,
    isolated,    ///< No triangle.
    voiceless,   ///< Only triangles that are degenerate or not finite.
    cancelling,  ///< Votes add up to nothing but rounding.
    non_finite,  ///< No position.
};

/// Vertices that share a normal.
struct Place {
    std::span<const std::uint32_t> vertices;
    PlaceKind kind = PlaceKind::sound;
    glm::vec3 normal{0.0F};  ///< Unit where the kind is sound.
};

/// Finds kind and normal of every place. No vertex is in two of them.
///
/// Time: a look at each block of triangles, and 1 microsecond a triangle at the places.
/// \param ranges  of the blocks, as sum_votes() leaves them
void find_exact_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                        std::span<const VertexRange> ranges, NormalWeight weight,
                        Arithmetic arithmetic, std::span<Place> places);

}  // namespace relief
