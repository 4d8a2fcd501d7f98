// SPDX-License-Identifier: Apache-2.0
/// \file
/// Some rows of a bake, from the owners of their samples to the means of their texels.
/// Tests: tests/mesh/bake/bake_test.cpp.
#pragma once

#include <limits>
#include <map>

#include "bake/bake_parts.h"
#include "bake/low_surface.h"
#include "relief/mesh/bake.h"

namespace relief {

/// What all rows have in common.
struct BakeWork {
    const BakeParts& parts;
    const LowSurface& low;
    const BakeOptions& options;
    int side = 1;  ///< Samples along each side of a texel.
};

/// Lengths of rays that would hit: their number, the shortest and longest, and a histogram.
class RayLengths {
  public:
    void add(double length);
    RayLengths& operator+=(const RayLengths& other);
    [[nodiscard]] ClippedRays summary() const;

  private:
    std::size_t count_ = 0;
    double shortest_ = std::numeric_limits<double>::infinity();
    double longest_ = 0.0;
    std::map<int, std::size_t> bins_;  ///< Eight equal ones for each power of two.
};

/// Counts over some rows; the order of sums does not matter.
struct BakeCounts {
    std::size_t samples = 0;
    std::size_t rays = 0;
    std::size_t occlusion_rays = 0;
    std::size_t baked = 0;
    std::size_t missed = 0;
    double least_height = std::numeric_limits<double>::infinity();
    double greatest_height = -std::numeric_limits<double>::infinity();
    std::vector<MissedTexel> first_missed;
    std::size_t missed_from_behind = 0;
    std::size_t measuring_rays = 0;
    RayLengths clipped_outside, clipped_inside;

    BakeCounts& operator+=(const BakeCounts& other);
};

/// Bakes rows of texels, on all threads.
///
/// \param owners  of the samples of these rows; `first_row` counts texels
/// \param rows    to be filled: as many rows as the owners are for
BakeCounts bake_rows(const BakeWork& work, int first_row, std::span<const CoveredTexel> owners,
                     const BakedRows& rows, Report& report);

}  // namespace relief
