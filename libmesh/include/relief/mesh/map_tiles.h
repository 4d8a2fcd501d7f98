// SPDX-License-Identifier: Apache-2.0
/// \file
/// Finds the UDIM tiles (unit squares of texture space) that triangles cover.
/// Tests: tests/mesh/bake/texel_coverage_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace relief {

/// The square from (x, y) to (x + 1, y + 1), with v down, and its triangles.
struct MapTile {
    glm::ivec2 tile{0, 0};
    std::vector<std::uint32_t> triangles;  ///< Ascending.
};

struct MapTiles {
    std::vector<MapTile> tiles;  ///< In order of UDIM numbers, without empty tiles.
    /// Triangles completely outside of the allowed tiles, partly outside, and with coordinates that
    /// are not finite; ascending.
    std::vector<std::uint32_t> outside, partly_outside, not_finite;
};

/// The allowed tiles, from the least to the greatest indices.
struct TileRange {
    glm::ivec2 least{0, 0};
    glm::ivec2 greatest{0, 0};
};

/// All tiles of a UDIM set: ten columns, from 1001 (v from 0 to 1, counted upwards) to 9999.
inline constexpr TileRange udim_tiles = {{0, -899}, {9, 0}};

/// Returns the UDIM number 1001 + u + 10 v, where (u, v) is the tile's lower left corner with v
/// upwards.
constexpr int udim_of(const glm::ivec2& tile) {
    return 1001 + tile.x - 10 * tile.y;
}

/// Finds the tiles of triangles.
///
/// A triangle belongs to a tile if it extends into it by more than 1e-5 of the tile's side, so that
/// triangles that end at a border, up to rounding errors, do not enter the next tile. A triangle
/// without area belongs to the tiles of its bounding box.
///
/// \param only  the triangles to consider, ascending; if absent, all
/// \throws InvalidInput if a triangle names a vertex that does not exist, or more than 1000 tiles
///         are covered
MapTiles tiles_of(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
                  const std::optional<std::span<const std::uint32_t>>& only,
                  const TileRange& range);

}  // namespace relief
