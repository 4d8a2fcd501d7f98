// SPDX-License-Identifier: Apache-2.0
/// \file
/// Integrates a normal map: computes the height field whose slopes have the least squared
/// difference from those of the normals.
/// Tests: tests/mesh/image/heights_from_normals_test.cpp.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>

#include "relief/mesh/bump.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

struct IntegrationOptions {
    /// The kernel whose slopes are matched: the one with which normals_from_height() will be
    /// called.
    Kernel kernel = Kernel::central7;
    int gaussian_radius = 2;  ///< The radius of Kernel::gaussian in texels.
    Wraps wrap;
    glm::dvec2 texel{1.0, 1.0};  ///< As in BumpOptions; heights have its unit.
    /// Maximum length of a slope. Steeper normals, and normals that face sideways or back, are
    /// clamped to it. The default is 86 degrees; there, one 8-bit code of z already changes the
    /// slope by one sixteenth.
    double max_slope = 16.0;
    /// Subtracts the mean slope first. If flat texels have an error of one 8-bit code, the mean
    /// slope is 0.8%, which adds up to large heights in maps with clamped borders.
    bool level = false;
};

struct IntegratedHeights {
    Image heights;         ///< One float channel in the unit of the texel; the minimum is 0.
    double highest = 0.0;  ///< The maximum height.
    /// The RMS of the remaining difference of slopes over both axes, which no height field can
    /// have. 0 if the map was made from heights by the same kernel.
    double residual_slope = 0.0;
    DirectionError residual;  ///< The remaining angles between the normals, in degrees.
    double rms_slope = 0.0;   ///< The RMS slope of the map, for comparison.
    /// The mean slope of the map to the right and upwards, before `level` is applied.
    glm::dvec2 mean_slope{};
    int rounds = 1;  ///< Number of iterations; 1 unless a wrap is clamp.
};

/// Computes heights by least squares: no other height field has slopes, by the kernel, that are
/// closer to those of the normals.
///
/// \param normals  three float channels, y up, as from decode_normal_map(); any length
/// \param report  counts texels whose normal is not finite or zero (read as flat), faces sideways
///         or back, or is steeper than `steepest` (clamped)
/// \return heights from which normals_from_height() with the same kernel, wrap and texel reproduces
///         the normals as closely as possible. Waves shorter than 3 texels, to which kernels hardly
///         respond, keep small amplitudes, with relative slope errors of up to 1e-3. A map without
///         slopes gives 0 everywhere. The same bits for any number of threads
/// \throws InvalidInput if the image is empty or not three float channels, or if the texel, the
///         radius or `steepest` (1e-3 to 1e6) is out of range
///
/// If both wraps are repeat or mirror and the kernel is symmetric, the solution is computed
/// directly by fast transforms; otherwise by conjugate gradients with these transforms as the
/// preconditioner. Memory beside normals and result: 8 bytes per texel, or 40 if a wrap is clamp.
/// Source: [Frankot and Chellappa 1988], with the response of the kernel instead of the derivative.
IntegratedHeights heights_from_normals(const Image& normals, const IntegrationOptions& options,
                                       Report& report);

}  // namespace relief
