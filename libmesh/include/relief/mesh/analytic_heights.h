// SPDX-License-Identifier: Apache-2.0
/// \file
/// Height fields whose slopes are known in closed form: the ground truth that slope kernels are
/// measured against. Tests: tests/mesh/accuracy/analytic_heights_test.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/direction_error.h"
#include "relief/mesh/image.h"

namespace relief {

/// amplitude * sin(frequency . (x, y) + phase) with x to the right and y down, in texels.
struct HeightWave {
    double amplitude = 1.0;  ///< Texels.
    glm::dvec2 frequency{};  ///< Radians a texel.
    double phase = 0.0;
};

/// A field with the truth about it.
struct AnalyticHeights {
    Image heights;                    ///< One float channel, in texels: convert with strength 1.
    std::vector<glm::dvec3> normals;  ///< Of the field before it was rounded to float; unit, y up.
};

/// The sum of waves, sampled at texel centres. \throws InvalidInput if a size is not positive
AnalyticHeights wave_heights(int width, int height, std::span<const HeightWave> waves);

/// A height, and how it changes to the right and downwards; in texels.
struct HeightAt {
    double height = 0.0;
    glm::dvec2 slope{};
};

/// Any field, sampled at texel centres (x, y) = (0, 0), (1, 0), ...
///
/// \param field  called from several threads
/// \throws InvalidInput if a size is not positive
AnalyticHeights sampled_heights(int width, int height,
                                const std::function<HeightAt(const glm::dvec2& place)>& field);

/// The sum of waves at a place.
HeightAt waves_at(std::span<const HeightWave> waves, const glm::dvec2& place);

/// Waves that make a field tile: each goes a whole number of times into width and height.
///
/// \param shortest   texels; the wavelengths lie between this and the longer side
/// \param rms_slope  of the sum, if no two waves have the same frequency; all waves have the same
///                   share. Waves of equal frequency interfere, and the slope of the sum differs
/// \param seed       of directions, lengths and phases: same seed, same waves, on every machine
/// \throws InvalidInput if a size or the count is not positive, or no wave that tiles is that long
std::vector<HeightWave> tiling_waves(int width, int height, int count, double shortest,
                                     double rms_slope, std::uint32_t seed);

/// The heights as a file of 8 or 16 bits has them: least and greatest become the ends of the range,
/// the rest is rounded to the nearest code; and the strength and offset that undo it.
struct CodedHeights {
    Image codes;            ///< One channel of 8 or 16 bits.
    double strength = 0.0;  ///< Texels from code 0 to the largest.
};
/// \throws InvalidInput if the field is empty or not one float channel, or bits is not 8 or 16
CodedHeights coded_heights(const Image& heights, int bits);

/// How far normals are from the truth, those within `margin` texels of the border left out.
///
/// \param normals  three float channels, as many texels as there are true ones
/// \throws InvalidInput if the sizes differ
DirectionError normal_error(const Image& normals, const AnalyticHeights& truth, int margin = 0);

}  // namespace relief
