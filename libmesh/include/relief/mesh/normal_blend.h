// SPDX-License-Identifier: Apache-2.0
/// \file
/// A detail normal map laid over a base map. Tests: tests/mesh/image/normals/normal_blend_test.cpp;
/// how far each method is from the truth: docs/normal-maps.md.
#pragma once

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// With base b and detail d, both unit, z out of the surface; each result is made unit.
enum class NormalBlend {
    /// d turned by the shortest rotation that takes (0,0,1) to b: detail carved into the base.
    /// [Barré-Brisebois and Hill 2012]
    reoriented,
    /// Slopes added, (b.xy d.z + d.xy b.z, b.z d.z): exactly the sum of two height fields.
    partial_derivative,
    whiteout,  ///< (b.xy + d.xy, b.z d.z): hardly less steep than the sum of slopes.
    udn,       ///< (b.xy + d.xy, b.z): cheap; detail fades on slopes.
    unity,     ///< d in a frame of b's components turned by 90 degrees about x and y.
    linear,    ///< b + d: both at half their slope.
    overlay,   ///< Image editors' Overlay on (n + 1) / 2: bends what is not nearly flat.
};

inline constexpr NormalBlend all_normal_blends[] = {
    NormalBlend::reoriented, NormalBlend::partial_derivative,
    NormalBlend::whiteout,   NormalBlend::udn,
    NormalBlend::unity,      NormalBlend::linear,
    NormalBlend::overlay};

/// Lays a detail map over a base map, in place.
///
/// \param base    three float channels, unit, y up; becomes the result, unit
/// \param detail  the same, of any size: repeated from the upper left corner on; see fitted_detail
///                (normal_resize.h) for one that is to be stretched
/// \param report  counts texels where the result has no direction, or (reoriented) the base faces
///                straight back: they stay the base's; and those that reoriented or unity turn so
///                far that they face back where the base does not: both slopes are steep there
/// \throws InvalidInput if an image is empty or not of three float channels
///
/// A flat detail changes nothing, to within rounding, but with `linear` and `overlay`; a flat base
/// gives the detail, but with these and `udn`, which is steeper than it.
void blend_normals(Image& base, const Image& detail, NormalBlend method, Report& report);

}  // namespace relief
