// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is done to the normals of a map one by one: axes turned round, a missing z found, lengths
/// looked at, slopes made steeper or gentler.
/// Tests: tests/mesh/image/normals/normal_map_operations_test.cpp.
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

/// What becomes x, y and z, in terms of what was: a signed permutation.
using AxisMapping = std::array<SignedAxis, 3>;
inline constexpr AxisMapping same_axes = {{{0, false}, {1, false}, {2, false}}};

/// Turns the stored vectors of a map round, code by code, without decoding them.
///
/// \param map   three or four channels; a fourth is left alone
/// \param flat  for 8 and 16 bits
/// \param report  counts samples of code 0 under FlatCode::middle that are negated: they stand for
///                -1, as 1 does, and become the largest code; 1 is what they come back as
/// \throws InvalidInput if the image has fewer than three channels, or if an axis comes twice
///
/// Else a mapping and its inverse give back every code; float samples come back within 2^-24.
void map_axes(Image& map, const AxisMapping& mapping, FlatCode flat, Report& report);

/// The same for unit normals that are decoded, exactly: three float channels.
void turn_normals(Image& normals, const AxisMapping& mapping);

/// Which channels of an image hold x and y.
struct XyChannels {
    int x = 0;
    int y = 1;
};

/// Unit normals from x and y alone: z is what makes them unit, and faces outwards.
///
/// \param map  two to four channels; the whole map for FlatTexels::exact
/// \return three float channels, unit, y up. Where x and y alone are longer than 1, as compression
///         leaves them, z is 0 and they are shortened.
/// \param report  counts those, and texels that are not finite: read as flat
/// \throws InvalidInput if the image is empty or lacks one of the channels
Image decode_xy_map(const Image& map, const XyChannels& channels, Green green, FlatCode flat,
                    Report& report, FlatTexels texels = FlatTexels::as_coded);

/// How long the vectors of a map are.
struct LengthSpread {
    double least = 0.0;
    double mean = 0.0;
    double greatest = 0.0;
};

/// Looks at the lengths of a map's vectors and changes nothing: decode_normal_map takes them for
/// the directions that they have.
///
/// \param report  counts those not of length 1 by more than rounding, or dithering, to the map's
/// own
///                codes can do (sqrt(3) codes; 0.001 for float, as half needs it)
/// \return of the vectors whose length is a number
/// \throws InvalidInput if the image is empty or has fewer than three channels
LengthSpread count_lengths(const Image& map, FlatCode flat, Report& report);

/// Multiplies the slopes of unit normals, in place: as if heights had been multiplied.
///
/// \param normals   three float channels, unit
/// \param strength  within +-1e6; negative turns bumps into dents, 0 makes all flat
/// \param report    counts normals that do not face outwards (z not above 0), which have no slope:
///                  x and y are multiplied all the same; and those left without direction: flat
/// \throws InvalidInput if the image is not of three float channels, or the strength out of range
void scale_slopes(Image& normals, double strength, Report& report);

/// Steeper slopes than this, 89.94 degrees, are none that a height map of any use has.
inline constexpr double largest_slope = 1024.0;

/// Slopes of the surface with these unit normals: two float channels, dh/dx to the right and dh/dy
/// upwards, as slopes_from_height gives them.
///
/// \param report  counts normals that are steeper than largest_slope or do not face outwards: their
///                slope is that long, in their own direction (or 0 for (0,0,-1))
/// \throws InvalidInput if the image is not of three float channels
Image slopes_from_normals(const Image& normals, Report& report);

/// The unit normals of a surface with these slopes. \throws InvalidInput if it has no two floats
Image normals_from_slopes(const Image& slopes, Report& report);

}  // namespace relief
