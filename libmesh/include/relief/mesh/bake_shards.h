// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bakes a map in shards: several processes, on one machine or on many, bake some rows each, and
/// the map is made from their results. It has the same bytes as a map that is baked at once,
/// because everything that depends on several rows (padding, statistics, the order of findings) is
/// computed from the merged rows. Part of the library relief::bake.
/// Tests: tests/mesh/bake/bake_shards_test.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/texel_coverage.h"

namespace RELIEF_API relief {

/// Statistics of ray lengths that would hit; the order of sums has no influence.
struct RayLengths {
    std::size_t count = 0;
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0.0;
    std::map<int, std::size_t> bins{};  ///< Eight equal bins for each power of two.

    void add(double length);
    RayLengths& operator+=(const RayLengths& other);
    [[nodiscard]] ClippedRays summary() const;

    friend bool operator==(const RayLengths&, const RayLengths&) = default;
};

/// Counts over some rows of a map, as in BakeResult; the order of sums has no influence.
struct BakeCounts {
    std::size_t samples = 0;
    std::size_t rays = 0;
    std::size_t occlusion_rays = 0;
    std::size_t thickness_rays = 0;
    std::size_t open_thickness_rays = 0;
    std::size_t baked = 0;   ///< Texels.
    std::size_t missed = 0;  ///< Texels.
    double min_height = std::numeric_limits<double>::infinity();
    double max_height = -std::numeric_limits<double>::infinity();
    std::vector<MissedTexel> first_missed{};  ///< In order of row and column, at most 8.
    std::size_t missed_from_behind = 0;
    std::size_t measuring_rays = 0;
    RayLengths clipped_outside{}, clipped_inside{};

    BakeCounts& operator+=(const BakeCounts& other);
};

/// A layer that rows may hold.
struct RowLayer {
    std::span<float> BakedRows::*values;
    std::size_t channels;
    bool (*is_requested)(const BakeLayers& layers);
};

/// Returns all layers, for programs that store rows and read them again.
std::span<const RowLayer> row_layers();

/// Everything that a bake of some rows finds, besides the texels.
struct BakeShard {
    BakeRowRange rows;
    /// The coverage in the bands of 64 rows of samples that begin in these rows: each band counts
    /// once.
    Coverage coverage{};
    BakeCounts counts{};
    Report triangles{};  ///< Findings about triangles; only with row 0.
    Report texels{};     ///< Findings about the coverage, of the same bands as `coverage`.
    Report rays{};       ///< Findings of the bake itself.
};

/// Rows of one of several maps.
struct ShardRows {
    std::size_t map = 0;  ///< Its index.
    BakeRowRange rows;    ///< Multiples of 4, or the height of the map.

    friend bool operator==(const ShardRows& a, const ShardRows& b) {
        return a.map == b.map && a.rows.first == b.rows.first && a.rows.last == b.rows.last;
    }
};

/// Divides the rows of maps into shards with about the same number of covered texels.
///
/// \param low    with texture coordinates
/// \param maps   their sizes, placements and triangles are used
/// \param shard  the index of the shard, below `count`
/// \param count  the number of shards, at least 1
/// \return the rows of the shard, by map and row. Over all shards, every row of every map occurs
///         once. A shard is empty if there are more shards than groups of 4 rows. Coverage is
///         measured on reduced maps of at most 1024 columns and one row for 4. Texels that no
///         triangle covers count 1/256
/// \throws InvalidInput if an argument is out of range
std::vector<ShardRows> rows_of_shard(const Mesh& low, std::span<const BakeMapOptions> maps,
                                     std::size_t shard, std::size_t count);

/// Makes a map from the shards of Baker::bake_shard().
///
/// \param map        as for Baker::bake(); of the rays, only the requested layers are used
/// \param distances  Baker::distances()
/// \param shards     in order of rows, from row 0 to the height of the map
/// \param read       fills the given rows: states, and all layers of baked texels. Called from the
///                   top; row counts are multiples of 64, except for the last rows. Other texels
///                   have their values already, see BakedRows
/// \param take, report, execution  as for Baker::bake()
/// \return as Baker::bake()
/// \throws InvalidInput if rows are missing or occur twice, or an option is out of range; Cancelled
BakeResult merge_shards(const BakeMapOptions& map, const BakeDistances& distances,
                        std::span<const BakeShard> shards,
                        const std::function<void(const BakedRows& rows)>& read,
                        const std::function<void(const BakedRows& rows)>& take,
                        Report& report = IgnoredReport(), const ExecutionOptions& execution = {});

}  // namespace relief
