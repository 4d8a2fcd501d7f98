// SPDX-License-Identifier: Apache-2.0
/// \file
/// Applies per-texel operations to normals: axis permutations, reconstruction of z, length
/// statistics, and scaling of slopes.
/// Tests: tests/mesh/image/normal_map_operations_test.cpp.
#pragma once

#include <array>

#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace relief {

/// One of the axes x, y, z, or its opposite.
struct SignedAxis {
    int axis = 0;  ///< 0 to 2.
    bool is_negative = false;
    bool operator==(const SignedAxis&) const = default;
};

/// A signed permutation of axes: the sources of x, y and z.
using AxisMapping = std::array<SignedAxis, 3>;
inline constexpr AxisMapping same_axes = {{{0, false}, {1, false}, {2, false}}};

/// Permutes and negates the stored components of a map, without decoding them.
///
/// \param map  three or four channels; the fourth does not change
/// \param flat  for 8 and 16 bits
/// \param report  counts samples of code 0 under FlatCode::middle that are negated. They stand for
///         -1, as code 1 does, and become the maximum code; the inverse mapping returns 1
/// \throws InvalidInput if the image has fewer than three channels, or if an axis occurs twice
///
/// Except for these, a mapping followed by its inverse restores every code; float samples are
/// restored within 2^-24.
void map_axes(Image& map, const AxisMapping& mapping, FlatCode flat, Report& report);

/// The same for decoded normals, without rounding: three float channels.
void map_normal_axes(Image& normals, const AxisMapping& mapping);

/// The channels of an image that hold x and y.
struct XyChannels {
    int x = 0;
    int y = 1;
};

/// Reconstructs unit normals from x and y; z is the positive value that makes them unit.
///
/// \param map  two to four channels; FlatTexels::exact needs the whole map
/// \param report  counts texels whose x and y are longer than 1, as lossy compression causes (z
///         becomes 0, and they are normalized), and texels that are not finite (read as flat)
/// \return three float channels, unit, y up
/// \throws InvalidInput if the image is empty or lacks one of the channels
Image decode_xy_map(const Image& map, const XyChannels& channels, Green green, FlatCode flat,
                    Report& report, FlatTexels texels = FlatTexels::as_coded);

/// The lengths of the vectors of a map.
struct LengthRange {
    double least = 0.0;
    double mean = 0.0;
    double greatest = 0.0;
};

/// Measures the lengths of a map's vectors without changing it; decode_normal_map() normalizes
/// them.
///
/// \param report  counts vectors whose length deviates from 1 by more than rounding or dithering to
///         the map's codes causes (sqrt(3) codes; 0.001 for float, because of half floats)
/// \return statistics of finite lengths
/// \throws InvalidInput if the image is empty or has fewer than three channels
LengthRange measure_lengths(const Image& map, FlatCode flat, Report& report);

/// Multiplies the slopes of unit normals, in place, as if the heights had been multiplied.
///
/// \param normals  three float channels, unit
/// \param strength  within +-1e6; negative values turn bumps into dents, 0 makes all flat
/// \param report  counts normals whose z is not positive, which have no slope: their x and y are
///         multiplied anyway; and results without direction, which become flat
/// \throws InvalidInput if the image is not three float channels, or the strength is out of range
void scale_slopes(Image& normals, double strength, Report& report);

/// The maximum slope, 89.94 degrees; useful height maps have no steeper ones.
inline constexpr double largest_slope = 1024.0;

/// Converts unit normals to slopes: two float channels, dh/dx to the right and dh/dy upwards, as
/// from slopes_from_height().
///
/// \param report  counts normals that are steeper than largest_slope or do not face outwards: their
///         slope keeps its direction and gets the maximum length (or 0 for (0,0,-1))
/// \throws InvalidInput if the image is not three float channels
Image slopes_from_normals(const Image& normals, Report& report);

/// Converts slopes to unit normals. \throws InvalidInput if the image is not two float channels
Image normals_from_slopes(const Image& slopes, Report& report);

}  // namespace relief
