// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes texture coordinates for a mesh: divides it into charts, flattens them, and packs them
/// into a map. Tests: tests/mesh/atlas/unwrap_test.cpp, tests/mesh/atlas/injectivity_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The property that charts keep in the map, as far as their curvature permits.
enum class Flattening {
    arap,       ///< Lengths: as rigid as possible.
    conformal,  ///< Angles. The density of texels varies more.
};

template <>
inline constexpr auto enum_names<Flattening> = std::to_array<EnumName<Flattening>>(
    {{"arap", Flattening::arap}, {"conformal", Flattening::conformal}});

struct UnwrapOptions {
    glm::ivec2 size{2048};  ///< Of the map in texels, 16 to 65536 each.
    /// The minimum distance between two charts in texels, 0 to 256; half of it at the edges of the
    /// map. Bilinear lookups in mip level k need 3 * 2^k.
    int padding = 4;
    /// The largest permitted ratio, above 1, of the two singular values of a triangle, and of its
    /// area in the map to its area on the surface. Triangles below a millionth of the whole area,
    /// or below a tenth of the mean one if that is less, may exceed it, because their corners are
    /// rounded.
    double max_stretch = 4.0;
    /// Without effect with `repack`. Conformal charts have the same mean density of texels.
    Flattening flattening = Flattening::arap;
    bool keep_seams = false;       ///< The seams of existing texture coordinates stay seams.
    bool split_materials = false;  ///< No chart has triangles of two materials.
    /// Radians, 0 to pi: edges with a larger angle between their triangles are between two charts
    /// where that is possible. 0: all edges that are not flat (above 1e-5, which rounding may
    /// cause). Absent: none.
    std::optional<double> split_hard = std::nullopt;
    /// Keeps the charts of the existing texture coordinates, with their shapes and relative sizes
    /// in a map of these proportions, and only packs them anew. They are not tested: what overlaps
    /// or is inverted within a chart stays so, which is reported. Limits of charts have no effect.
    bool repack = false;
    /// Reflects mirrored charts, with `repack`.
    bool unmirror = false;
    /// Parts (triangles that are joined across edges) that are equal up to a rotation and a shift,
    /// to 1e-4 of their longest edge, and in materials and densities have the same texture
    /// coordinates. Mirrored parts are not equal.
    bool stack = false;
    /// Charts share no square block of this many texels, 1 to 64: 4 for BC compression.
    int alignment = 1;
    /// The number of maps of this size, 1 to 100: tiles of UDIM. Tile i is the unit square at u =
    /// i % 10 and, with v upwards, v = i / 10. No chart is in two tiles. All tiles have one
    /// density.
    int tiles = 1;
    /// Texels per unit of the mesh, above 0; absent: as many as fit into the map.
    std::optional<double> texels_per_unit = std::nullopt;
    /// The relative density of texels of each triangle, above 0; empty: equal. A chart has the mean
    /// of its area, and no chart has neighbors whose densities differ by more than a factor of 2.
    /// `texels_per_unit` is that of density 1. Without effect with `repack`.
    std::vector<float> densities{};
    /// The first vertex of each part of the mesh, ascending from 0: parts are not joined, even if
    /// they have equal positions. Empty: the mesh is one part.
    std::vector<std::uint32_t> first_vertices{};
    ExecutionOptions execution;
};

/// The quality of texture coordinates. Shares are of the area on the surface.
struct AtlasStats {
    std::size_t charts = 0;
    /// Parts that share the texels of an equal one, with `stack`: no other value counts them.
    std::size_t stacked_parts = 0;
    std::size_t small_charts = 0;  ///< Charts below 64 texels.
    double used = 0.0;             ///< The share of all tiles that charts cover.
    double texels_per_unit = 0.0;  ///< The mean: the root of the ratio of both areas.
    double min_density = 0.0;      ///< Relative to the mean; 5 % of the area are below.
    double max_density = 0.0;      ///< Relative to the mean; 5 % of the area are above.
    /// The L2 stretch of [Sander et al. 2001], at least 1 for maps that keep the whole area.
    double stretch = 0.0;
    double mean_anisotropy = 0.0;  ///< The mean ratio of both singular values, at least 1.
    double max_anisotropy = 0.0;   ///< Of the triangles that UnwrapOptions::max_stretch limits.
    double seam_length = 0.0;      ///< Of the borders of charts, in units of the mesh.
    /// The seam length divided by the root of the area.
    double relative_seam_length = 0.0;
    double area = 0.0;       ///< Of the surface, in square units of the mesh.
    double perimeter = 0.0;  ///< Of all charts in the map, in texels.
    /// The share of all tiles that half of the padding takes around each chart: p g / 2 + pi g^2 /
    /// 4 texels for a perimeter p and a padding g. It is exact for convex charts, so that these
    /// cover at most 1 - padding_share, however well they are packed; charts with narrow bays need
    /// less. Absent for coordinates that are only measured.
    std::optional<double> padding_share = std::nullopt;
    /// The highest mip level in which bilinear lookups in one chart do not reach another one: level
    /// k needs a distance of 3 * 2^k texels. Absent if not even level 0 is safe.
    std::optional<int> safe_mip_level = std::nullopt;
};

struct Unwrapped {
    /// Three for each triangle, in corner order: multiples of 2^-24 within [0,1], or with several
    /// tiles of 2^-20 within these. Triangles without area and non-finite ones have (0, 0).
    std::vector<glm::vec2> corner_texcoords;
    /// For each triangle; none for those that have no area or are not finite.
    std::vector<std::optional<std::uint32_t>> chart;
    AtlasStats stats;
};

/// Computes texture coordinates for all triangles.
///
/// \param mesh  valid (mesh.h); vertices with equal positions count as one. Existing texture
///         coordinates matter only with `keep_seams` and `repack`
/// \param report  counts triangles without area, non-finite and repeated ones, and edges of more
///         than two triangles; with `repack` also mirrored charts and those with overlaps
/// \return no two triangles overlap (except those of equal parts with `stack`), none is mirrored,
/// and the charts keep the padding. That is
///         tested with integers, because floats hold the coordinates exactly.
///         Repeated triangles have the coordinates of the first one
/// \throws InvalidInput if the mesh is not valid, an option is out of range, the charts do not fit
///         into the map with the requested padding or density, or there is nothing to repack
///
/// Every mesh has a result. Non-manifold edges are cut, except for their flattest pairs of
/// triangles. Charts that cannot be flattened within the limits are divided, if necessary down to
/// single triangles. The same input gives the same coordinates for any order of triangles, vertices
/// and corners, any number of threads, compiler and instruction set. The time is nearly linear.
///
/// Source: charts as in [Cohen-Steiner et al. 2004], merged in rounds; flattening [Liu et al.
/// 2008]; docs/unwrap.md.
Unwrapped unwrap(const Mesh& mesh, const UnwrapOptions& options = {},
                 Report& report = IgnoredReport());

/// Returns a mesh with texture coordinates; vertices are split along seams. Its tangents are
/// removed, because they belong to the old coordinates. \throws InvalidInput if `unwrapped` is not
/// that of the mesh
FramedMesh with_texcoords(const Mesh& mesh, const Unwrapped& unwrapped);

}  // namespace relief
