// SPDX-License-Identifier: Apache-2.0
/// \file
/// The same surface of waves at another resolution: the truth about resized normal maps.
#pragma once

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

/// The true normals of a field as an image.
inline Image normals_image(int width, int height, const std::vector<HeightWave>& waves) {
    const AnalyticHeights field = wave_heights(width, height, waves);
    Image image = make_image(width, height, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = static_cast<float>(field.normals[i / 3][static_cast<int>(i % 3)]);
    return image;
}

}  // namespace relief::test
