// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which triangle covers each texel of a map: where on a mesh the texel is.
/// Tests: tests/mesh/bake/texel_coverage_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>

#include "relief/mesh/report.h"

namespace relief {

/// The place of a texel on a mesh.
struct CoveredTexel {
    static constexpr std::uint32_t nobody = 0xffffffff;

    std::uint32_t triangle = nobody;
    /// Weights of the triangle's second and third corner; the first has the rest. None is negative.
    /// Where the texel's centre lies outside the triangle: of the nearest point on it.
    float second = 0.0F;
    float third = 0.0F;
    bool is_inside = false;  ///< Its centre is inside the triangle.

    [[nodiscard]] bool is_covered() const { return triangle != nobody; }
    [[nodiscard]] glm::vec3 weights() const { return {1.0F - second - third, second, third}; }
};

struct CoverageOptions {
    int width = 0;  ///< Of the map, in texels, 1 to 65536.
    int height = 0;
    /// The unit square that the map shows: (0, 0), or another tile of a UDIM set, v counted
    /// downwards as everywhere.
    glm::ivec2 tile{0, 0};
    /// What is outside that square is on the map too, moved by whole numbers, as for textures that
    /// repeat; else it is left out. `tile` makes no difference then.
    bool repeat = false;
    /// Texels whose centre no triangle holds belong to the nearest triangle that has a part in
    /// their square; so that no chart is lost for being small.
    bool touched = true;
    /// For maps of several samples a texel, 1, 2, 4, 8, 16 or 32 along each of its sides: "texels"
    /// here are samples then, and those of a whole texel are reported once, by the index of the
    /// texel.
    int samples_across = 1;
    /// Only these triangles, ascending; indices stay as they are. Absent: all. The span must
    /// outlive what it is given to.
    std::optional<std::span<const std::uint32_t>> only{};
};

/// What there was, over the whole map.
struct Coverage {
    std::size_t inside = 0;   ///< Texels with their centre in a triangle.
    std::size_t touched = 0;  ///< Texels that only have another part in one.
    std::size_t empty = 0;
    std::size_t shared = 0;  ///< Texels of `inside` whose centre is in several triangles.
    /// Those of `shared` with one triangle whose texture is mirrored and one whose is not: a
    /// mirrored model shows such texels twice on purpose.
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

/// Finds the owner of every texel.
///
/// \param texcoords  upper left origin, v down (mesh.h)
/// \param triangles  vertex indices
/// \param take       gets whole rows, from `first_row` on, row by row; each row of the map once.
///                   Called from several threads at once, for different rows
/// \param report     counts triangles that own nothing because they are not finite, have no area in
///                   the image (after rounding, below), or are too far away: 2^33 texels, or 64
///                   turns across where the texture repeats; texels whose centre is in several
///                   triangles; and apart from those, texels of Coverage::mirrored
/// \throws InvalidInput if a size is out of range or a triangle names a vertex that does not exist
///
/// *Who owns a texel.* The triangle that holds its centre. Coordinates are rounded to fixed-point
/// numbers first (2^-18 of a texel for 1024 of them, 2^-14 for 16384) and all tests are exact, by
/// the top-left rule: a centre on an edge or corner belongs to exactly one of the triangles that
/// meet there without overlapping. Of several that overlap, a triangle whose texture is not
/// mirrored comes before one whose is; then the one whose corners come first in order of (u, v); of
/// equal ones the lowest index. So the owner depends on the order of triangles only among those
/// with the same three texture coordinates. A texel whose centre nobody holds belongs, if `touched`
/// is set, to the triangle nearest to its centre among those with a part inside its square, ties
/// broken alike.
///
/// The same for any number of threads. Memory: 1.6 MB by thread and 1024 texels of width, and 4
/// bytes for every triangle and 64 rows that it reaches into.
Coverage cover_texels(
    std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
    const CoverageOptions& options,
    const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
    Report& report);

/// The same in several calls, for those who want the map from the top, or not all at once.
class TexelCover {
  public:
    /// First rows are multiples of this, last ones too or the map's end.
    static constexpr int band_rows = 64;
    static constexpr int largest_side = 65536;

    /// \param texcoords, triangles, options, report  as above; spans must outlive this. The report
    ///        gets what is said of triangles
    TexelCover(std::span<const glm::vec2> texcoords, std::span<const glm::uvec3> triangles,
               const CoverageOptions& options, Report& report);
    ~TexelCover();
    TexelCover(const TexelCover&) = delete;
    TexelCover& operator=(const TexelCover&) = delete;

    /// The owners of the texels of some rows, and what there was there.
    /// \param report  gets what is said of texels
    Coverage cover(
        int first_row, int last_row,
        const std::function<void(int first_row, std::span<const CoveredTexel> texels)>& take,
        Report& report) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace relief
