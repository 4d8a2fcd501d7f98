// SPDX-License-Identifier: Apache-2.0
/// \file
/// Surfaces of waves for normal maps: with a given slope, and the same surface at another
/// resolution.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/analytic_heights.h"

namespace relief::test {

/// \param scale  texels of the waves' own field to one of the other; both fields have their upper
///               left corner in common
inline std::vector<HeightWave> resized_waves(std::vector<HeightWave> waves, double scale) {
    for (HeightWave& wave : waves) {
        // The middle of texel i is at (i + 0.5) scale - 0.5.
        wave.phase += (wave.frequency.x + wave.frequency.y) * (scale - 1.0) / 2.0;
        wave.frequency *= scale;
        wave.amplitude /= scale;
    }
    return waves;
}

/// Root of the mean square of the slopes at the texels of a field.
inline double rms_slope_of(int width, int height, const std::vector<HeightWave>& waves) {
    double squares = 0.0;
    for (const glm::dvec3& normal : wave_heights(width, height, waves).normals)
        squares += (normal.x * normal.x + normal.y * normal.y) / (normal.z * normal.z);
    return std::sqrt(squares / (static_cast<double>(width) * height));
}

/// The same waves with their amplitudes multiplied by a factor.
inline std::vector<HeightWave> scaled_waves(std::vector<HeightWave> waves, double factor) {
    for (HeightWave& wave : waves)
        wave.amplitude *= factor;
    return waves;
}

/// tiling_waves() whose field has exactly this slope. Waves of equal frequency interfere, so that
/// the slope of tiling_waves() alone is only about the one that was asked for.
inline std::vector<HeightWave> waves_with_slope(int side, int count, double shortest,
                                                double rms_slope, std::uint32_t seed) {
    const std::vector<HeightWave> waves =
        tiling_waves(side, side, count, shortest, rms_slope, seed);
    return scaled_waves(waves, rms_slope / rms_slope_of(side, side, waves));
}

/// The true normals of a field as an image.
inline Image normals_image(int width, int height, const std::vector<HeightWave>& waves) {
    const AnalyticHeights field = wave_heights(width, height, waves);
    Image image = make_image(width, height, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = static_cast<float>(field.normals[i / 3][static_cast<int>(i % 3)]);
    return image;
}

}  // namespace relief::test
