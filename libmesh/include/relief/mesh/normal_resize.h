// SPDX-License-Identifier: Apache-2.0
/// \file
/// Resizes normal maps. docs/normal-maps.md has the errors of the filters.
/// Tests: tests/mesh/image/normal_resize_test.cpp
#pragma once

#include <glm/vec2.hpp>

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

/// The filter kernel. When an image is reduced, the kernel is widened by the same factor.
enum class ResizeFilter {
    /// The texels that the new one covers, weighted by area; for enlargement the nearest texel.
    box,
    triangle,  ///< Linear interpolation.
    cubic,     ///< The Catmull-Rom spline, which interpolates the texels.
    lanczos,   ///< Three lobes: the sharpest.
    /// The filter with the smallest error along each axis: lanczos to reduce, cubic to enlarge.
    best,
};

/// The quantity that is averaged.
enum class ResizeDomain {
    slopes,   ///< Slopes: the result has the normals of the filtered surface.
    vectors,  ///< The normals themselves, with normalization; steep texels have less weight.
};

/// The maximum slope for averaging slopes, 86.4 degrees. Steeper normals would dominate their
/// neighborhood; where they contribute, vectors are averaged instead.
inline constexpr float max_averaged_slope = 16.0F;

struct ResizeOptions {
    ResizeFilter filter = ResizeFilter::best;
    ResizeDomain domain = ResizeDomain::slopes;
    Wraps wrap;
    /// Number of repetitions of the map in the result along each axis, above 0.
    glm::dvec2 repeat{1.0, 1.0};
};

/// Resizes normals. Slopes do not change: the size of texels changes, not the surface.
///
/// \param normals  three float channels, unit
/// \param width, height  positive
/// \param report  counts texels whose mean vector has no direction, which become flat; with
///         ResizeDomain::slopes also normals that are too steep for averaging slopes
/// \throws InvalidInput if the image is not three float channels, or a size or repeat is not
///         positive
///
/// At the same size and with one repetition, the result is bitwise equal to the input.
Image resize_normals(const Image& normals, int width, int height, const ResizeOptions& options,
                     Report& report);

/// Resizes any float samples, channel by channel, such as the alpha that belongs to normals.
/// \throws InvalidInput as resize_normals() does. options.domain is ignored
Image resize_samples(const Image& image, int width, int height, const ResizeOptions& options);

/// Resizes a detail map as blend_normals() needs it for a base of this size, so that it repeats
/// `options.repeat` times across the base. The result is one period if the base's size is a
/// multiple of it, else the whole area. It always wraps around; options.wrap is ignored.
Image fitted_detail(const Image& detail, int base_width, int base_height,
                    const ResizeOptions& options, Report& report);

}  // namespace relief
