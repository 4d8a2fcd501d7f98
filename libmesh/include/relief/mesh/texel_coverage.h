// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rasterizes the triangles of a mesh in texture space: finds the triangle and barycentric
/// coordinates of each texel, and the UDIM tiles that triangles cover.
/// Tests: tests/mesh/bake/texel_coverage_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The square from (x, y) to (x + 1, y + 1), with v down, and its triangles.
struct MapTile {
    glm::ivec2 tile{0, 0};
    std::vector<std::uint32_t> triangles;  ///< Ascending.
};

/// The UDIM tiles (unit squares of texture space) that triangles cover.
struct MapTiles {
    std::vector<MapTile> tiles;  ///< In order of UDIM numbers, without empty tiles.
    /// Triangles completely outside of the allowed tiles, partly outside, and with coordinates that
    /// are not finite; ascending.
    std::vector<std::uint32_t> outside, partly_outside, not_finite;
};

/// The allowed tiles, from the minimum to the maximum indices.
struct TileRange {
    glm::ivec2 min{0, 0};
    glm::ivec2 max{0, 0};
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

/// The position of a texel on a mesh.
struct CoveredTexel {
    static constexpr std::uint32_t no_triangle = 0xffffffff;

    std::uint32_t triangle = no_triangle;
    /// Barycentric weights of the triangle's second and third corner; that of the first is 1 minus
    /// their sum. None is negative. If the texel's center is outside of the triangle, they are
    /// those of the nearest point.
    float second = 0.0F;
    float third = 0.0F;
    bool is_inside = false;  ///< The center of the texel is inside of the triangle.

    [[nodiscard]] bool is_covered() const { return triangle != no_triangle; }
    [[nodiscard]] glm::vec3 weights() const { return {1.0F - second - third, second, third}; }
};

struct CoverageOptions {
    int width = 0;  ///< Width of the map in texels, 1 to 65536.
    int height = 0;
    /// The unit square of the map: (0, 0), or another tile of a UDIM set, with v down.
    glm::ivec2 tile{0, 0};
    /// If true, triangles outside of the square are shifted into it by whole numbers, as for
    /// repeating textures, and `tile` has no effect. If false, they are omitted.
    bool repeat = false;
    /// If true, a texel whose center no triangle contains gets the nearest triangle that overlaps
    /// the texel's square, so that small charts are not lost.
    bool touched = true;
    /// Samples along each side of a texel: 1, 2, 4, 8, 16 or 32. If there are several, "texel" in
    /// this header means sample, but findings count each texel once by its index.
    int samples_across = 1;
    /// The triangles to rasterize, ascending, with unchanged indices. If absent, all.
    std::optional<std::vector<std::uint32_t>> only{};
};

/// Numbers of texels over the whole map.
struct Coverage {
    std::size_t inside = 0;   ///< Texels whose center is in a triangle.
    std::size_t touched = 0;  ///< Texels that a triangle overlaps, but not at the center.
    std::size_t empty = 0;
    std::size_t shared = 0;  ///< Texels of `inside` whose center is in several triangles.
    /// Texels of `shared` with both a mirrored and an unmirrored triangle, which is intended in
    /// models with mirrored texture coordinates.
    std::size_t mirrored = 0;

    Coverage& operator+=(const Coverage& other) {
        inside += other.inside;
        touched += other.touched;
        empty += other.empty;
        shared += other.shared;
        mirrored += other.mirrored;
        return *this;
    }
};

/// Finds the triangle of every texel.
///
/// \param texcoords  upper left origin, v down (mesh.h)
/// \param triangles  vertex indices
/// \param take  receives whole rows, starting with `first_row`, row by row; each row of the map
///         once. Called from several threads at once, for different rows
/// \param report  counts triangles that cover nothing because they are not finite, have no area in
///         the image (after rounding, see below), or are too far away: 2^33 texels, or 64
///         repetitions; texels whose center is in several triangles; and separately texels of
///         Coverage::mirrored
/// \throws InvalidInput if a size is out of range or a triangle names a vertex that does not exist
///
/// *Ownership.* A texel belongs to the triangle that contains its center. Coordinates are first
/// rounded to fixed point (2^-18 of a texel for maps of 1024 texels, 2^-14 for 16384), and all
/// tests are exact, with the top-left rule: a center on an edge or corner belongs to exactly one of
/// the triangles that meet there without overlap. If several triangles overlap, unmirrored ones
/// come before mirrored ones, then the triangle whose corners come first in the order of (u, v),
/// then the lowest index. So the result depends on the order of triangles only for triangles with
/// the same three texture coordinates. If `touched` is set, a texel whose center is in no triangle
/// belongs to the triangle that is nearest to its center among those that overlap its square, with
/// the same rules for ties.
///
/// The result is the same for any number of threads. Memory: 1.6 MB per thread and 1024 texels of
/// width, and 4 bytes for every triangle and band of 64 rows that it overlaps.
Coverage cover_texels(
    std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
    const CoverageOptions& options,
    const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
    Report& report = IgnoredReport());

/// The same in several calls, for bands of rows in any order.
class TexelRasterizer {
  public:
    /// First rows are multiples of this, and last rows too, except for the last row of the map.
    static constexpr int band_rows = 64;
    static constexpr int largest_side = 65536;

    /// \param texcoords, triangles, options, report  as above; spans must outlive this object. The
    ///         report receives findings about triangles
    TexelRasterizer(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
                    const CoverageOptions& options, Report& report = IgnoredReport());
    ~TexelRasterizer();
    TexelRasterizer(const TexelRasterizer&) = delete;
    TexelRasterizer& operator=(const TexelRasterizer&) = delete;

    /// Finds the triangles of the texels of some rows, and counts these texels.
    /// \param report  receives findings about texels
    Coverage cover(
        int first_row, int last_row,
        const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
        Report& report = IgnoredReport()) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
