// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generates height fields whose slopes are known in closed form. They are the ground truth for the
/// errors of derivative kernels.
/// Tests: tests/mesh/accuracy/analytic_surfaces_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/error_stats.h"
#include "relief/mesh/image.h"

namespace RELIEF_API relief {

/// The height amplitude * sin(dot(frequency, (x, y)) + phase); x points right and y down, both in
/// texels.
struct HeightWave {
    double amplitude = 1.0;  ///< In texels.
    glm::dvec2 frequency{};  ///< In radians per texel.
    double phase = 0.0;      ///< In radians.
};

/// A height field and its exact normals.
struct AnalyticHeights {
    Image heights;                    ///< One float channel, in texels: convert it with strength 1.
    std::vector<glm::dvec3> normals;  ///< Unit, y up; computed before heights are rounded to float.
};

/// Samples a sum of waves at texel centers. \throws InvalidInput if a size is not positive
AnalyticHeights wave_heights(int width, int height, std::span<const HeightWave> waves);

/// A height in texels and its derivatives to the right and downwards.
struct HeightSample {
    double height = 0.0;
    glm::dvec2 slope{};
};

/// Samples any height field at the texel centers (x, y) = (0, 0), (1, 0), ...
///
/// \param field  is called from several threads
/// \throws InvalidInput if a size is not positive
AnalyticHeights sampled_heights(int width, int height,
                                const std::function<HeightSample(const glm::dvec2& place)>& field);

/// Evaluates a sum of waves at a position in texels.
HeightSample evaluate_waves(std::span<const HeightWave> waves, const glm::dvec2& place);

/// Creates waves whose sum tiles: a whole number of periods of each wave fits into width and
/// height.
///
/// \param shortest  in texels; wavelengths lie between this and the longer side
/// \param rms_slope  RMS slope of the sum if all frequencies differ; each wave has the same share.
///         Waves of equal frequency interfere, and the RMS slope of the sum differs
/// \param seed  determines directions, lengths and phases; the same seed gives the same waves on
///         every machine
/// \throws InvalidInput if a size or the count is not positive, or if no wave that tiles is at
///         least `shortest` texels long
std::vector<HeightWave> tiling_waves(int width, int height, int count, double shortest,
                                     double rms_slope, std::uint32_t seed);

/// Heights as integer codes.
struct CodedHeights {
    Image codes;            ///< One channel of 8 or 16 bits.
    double strength = 0.0;  ///< The height of the maximum code above code 0, in texels.
};
/// Quantizes heights: the minimum becomes code 0, the maximum becomes the maximum code, and other
/// heights are rounded to the nearest code.
/// \throws InvalidInput if the field is empty or not one float channel, or bits is not 8 or 16
CodedHeights coded_heights(const Image& heights, int bits);

/// Computes the angles between normals and the exact normals.
///
/// \param normals  three float channels, of the same size
/// \param margin  width of the border that is ignored, in texels
/// \throws InvalidInput if the sizes differ
DirectionError normal_error(const Image& normals, const AnalyticHeights& reference, int margin = 0);

}  // namespace relief
