// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normal maps at other sizes. Tests: tests/mesh/image/normals/normal_resize_test.cpp; errors of
/// the filters: docs/normal-maps.md.
#pragma once

#include <glm/vec2.hpp>

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// What weighs the texels around a place. When an image shrinks, each is as much wider.
enum class ResizeFilter {
    box,       ///< The texels that the new one covers, by their share; enlarged: the nearest.
    triangle,  ///< Linear interpolation.
    cubic,     ///< Catmull and Rom's spline: goes through the texels.
    lanczos,   ///< Three lobes: the sharpest.
    best,      ///< Along each axis what errs least: lanczos to shrink, cubic to enlarge.
};

/// What is averaged.
enum class ResizeDomain {
    slopes,   ///< Those of the surface: the result has the normals of the surface filtered so.
    vectors,  ///< The normals themselves, made unit again: steep texels count for less.
};

/// Normals steeper than this, 86.4 degrees, would drown all slopes around them; where they count,
/// vectors are averaged instead.
inline constexpr float steepest_averaged_slope = 16.0F;

struct ResizeOptions {
    ResizeFilter filter = ResizeFilter::best;
    ResizeDomain domain = ResizeDomain::slopes;
    Wraps wrap;
    /// How often the map is to be seen in the result, side by side, along each axis; above 0.
    glm::dvec2 repeat{1.0, 1.0};
};

/// Unit normals at another size. What was a slope of 1 stays one: it is the texels that grow or
/// shrink, not the surface.
///
/// \param normals  three float channels, unit
/// \param width, height  positive
/// \param report  counts texels where the mean of the vectors has no direction: made flat; with
///                slopes, normals too steep for that
/// \throws InvalidInput if the image is not of three float channels, or a size or repeat is not
///         positive
///
/// At its own size, seen once, an image stays as it is to the bit.
Image resize_normals(const Image& normals, int width, int height, const ResizeOptions& options,
                     Report& report);

/// Any float samples at another size, channel by channel: an alpha that goes with normals.
/// \throws InvalidInput as resize_normals does; options.domain has no say
Image resize_samples(const Image& image, int width, int height, const ResizeOptions& options);

/// A detail map at the size that blend_normals needs for a base of this size, so that it is seen
/// `options.repeat` times across it: one period where the base's size is a multiple of that, the
/// whole area else. It wraps around by itself, whatever options.wrap says.
Image fitted_detail(const Image& detail, int base_width, int base_height,
                    const ResizeOptions& options, Report& report);

}  // namespace relief
