// SPDX-License-Identifier: Apache-2.0
/// \file
/// From a normal map back to heights: the field whose slopes are nearest to those of the normals.
/// Tests: tests/mesh/image/integration/heights_from_normals_test.cpp.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>

#include "relief/mesh/bump.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

struct IntegrationOptions {
    /// Whose slopes the heights should have: what normals_from_height() will be called with.
    Kernel kernel = Kernel::central7;
    int gaussian_radius = 2;  ///< Of Kernel::gaussian, in texels.
    Wraps wrap;
    glm::dvec2 texel{1.0, 1.0};  ///< As in BumpOptions; heights come in its unit.
    /// Slopes of steeper normals, and of those that face sideways or back, are cut to this length:
    /// 86 degrees, where one code of 8 bits in z is one sixteenth of the slope already.
    double steepest = 16.0;
    /// Takes the mean slope out first. A map whose flat texels are one code off is a slope of 0.8 %
    /// in all, which adds up to hills where borders are clamped.
    bool level = false;
};

struct IntegratedHeights {
    Image heights;         ///< One float channel in the unit of the texel; the lowest is 0.
    double highest = 0.0;  ///< The greatest of them.
    /// What is left of the slopes: no heights have them. 0 where the map comes from heights by the
    /// same kernel. Root mean square over both axes.
    double residual_slope = 0.0;
    DirectionError residual;  ///< The same as angles between the normals, in degrees.
    double rms_slope = 0.0;   ///< Of the map, to compare with.
    glm::dvec2 mean_slope{};  ///< Of the map, to the right and upwards; as it was before `level`.
    int rounds = 1;           ///< Of refinement; 1 unless a wrap is clamp.
};

/// Heights by least squares: no field has slopes nearer to those of the normals, when slopes are
/// taken by the kernel.
///
/// \param normals  three float channels, y up, as from decode_normal_map(); any length
/// \param report   counts texels whose normal is not finite or zero (taken as flat), faces sideways
///                 or back, or is steeper than `steepest` (cut to it)
/// \return heights of which normals_from_height() with the same kernel, wrap and texel gives the
///         normals back, as far as any heights do; to within 1e-3 of the slopes where waves are
///         shorter than 3 texels, which kernels hardly see: there, heights are kept small. A map
///         without slopes gives all 0. The same bits for any number of threads.
/// \throws InvalidInput if the image is empty or not of three float channels, or if the texel, the
///         radius or `steepest` is out of range (1e-3 to 1e6)
///
/// Directly by fast transforms where both wraps are repeat or mirror and the kernel symmetric; else
/// by conjugate gradients, which these transforms precondition. Memory: 8 bytes a texel beside
/// normals and result, 40 where a wrap is clamp. Source: [Frankot and Chellappa 1988], with the
/// kernel's own response in place of the derivative's.
IntegratedHeights heights_from_normals(const Image& normals, const IntegrationOptions& options,
                                       Report& report);

}  // namespace relief
