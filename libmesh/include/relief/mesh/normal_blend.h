// SPDX-License-Identifier: Apache-2.0
/// \file
/// Blends a detail normal map into a base normal map. docs/normal-maps.md has the error of each
/// method.
/// Tests: tests/mesh/image/normal_map_operations_test.cpp
#pragma once

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// Blending methods for unit normals: base b and detail d, with z out of the surface. Every result
/// is normalized.
enum class NormalBlend {
    /// d, rotated by the shortest rotation from (0,0,1) to b: the detail is carved into the base.
    /// [Barré-Brisebois and Hill 2012]
    reoriented,
    /// The sum of slopes, (b.xy d.z + d.xy b.z, b.z d.z): exactly that of two added height fields.
    partial_derivative,
    whiteout,  ///< (b.xy + d.xy, b.z d.z): slightly less steep than the sum of slopes.
    udn,       ///< (b.xy + d.xy, b.z): fast; the detail fades on slopes.
    unity,     ///< d in a frame whose axes are b rotated by 90 degrees about x and y.
    linear,    ///< b + d: both have half their slope.
    /// The Overlay mode of image editors on (n + 1) / 2: distorts all normals that are not nearly
    /// flat.
    overlay,
};

inline constexpr NormalBlend all_normal_blends[] = {
    NormalBlend::reoriented, NormalBlend::partial_derivative,
    NormalBlend::whiteout,   NormalBlend::udn,
    NormalBlend::unity,      NormalBlend::linear,
    NormalBlend::overlay};

/// Blends a detail map into a base map, in place.
///
/// \param base  three float channels, unit, y up; it becomes the result, unit
/// \param detail  three float channels, unit, y up, of any size; repeated from the upper left
///         corner. To scale it, see fitted_detail() (normal_resize.h)
/// \param report  counts texels whose result has no direction or, for reoriented, whose base normal
///         is (0,0,-1): they keep the base's normal; and texels whose result by reoriented or unity
///         faces back while the base does not, because both slopes are steep
/// \throws InvalidInput if an image is empty or not three float channels
///
/// A flat detail does not change the base, up to rounding, except for `linear` and `overlay`. A
/// flat base gives the detail, except for these two and `udn`, whose result is steeper than the
/// detail.
void blend_normals(Image& base, const Image& detail, NormalBlend method, Report& report);

}  // namespace relief
