// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which unit squares of texture space triangles reach into: the tiles of a UDIM set.
/// Tests: tests/mesh/bake/map_tiles_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace relief {

/// The square from (x, y) to (x + 1, y + 1), v counted downwards as everywhere, and whose it is.
struct MapTile {
    glm::ivec2 tile{0, 0};
    std::vector<std::uint32_t> triangles;  ///< Ascending.
};

struct MapTiles {
    std::vector<MapTile> tiles;  ///< By their UDIM numbers, none without triangles.
    /// Triangles with no part in any tile that may be, with some part outside of them, and without
    /// finite coordinates; ascending.
    std::vector<std::uint32_t> outside, partly_outside, not_finite;
};

/// Tiles that may be, from the least to the greatest.
struct TileRange {
    glm::ivec2 least{0, 0};
    glm::ivec2 greatest{0, 0};
};

/// All that a UDIM set can have: ten across, from 1001 at v upwards from 0 to 1, to 9999.
inline constexpr TileRange udim_tiles = {{0, -899}, {9, 0}};

/// 1001 + u + 10 v of the tile's lower left corner, v counted upwards.
constexpr int udim_of(const glm::ivec2& tile) {
    return 1001 + tile.x - 10 * tile.y;
}

/// Finds the tiles of triangles.
///
/// A triangle is in a tile if it reaches into it by more than 1e-5 of its side: what ends on a
/// border, or a rounding error beyond it, does not enter the next one. A triangle without area is
/// where its box is.
///
/// \param only  these triangles alone, ascending; absent: all
/// \throws InvalidInput if a triangle names a vertex that does not exist, or more than 1000 tiles
///         are entered
MapTiles tiles_of(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
                  const std::optional<std::span<const std::uint32_t>>& only,
                  const TileRange& range);

}  // namespace relief
