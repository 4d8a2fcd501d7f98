// SPDX-License-Identifier: Apache-2.0
/// \file
/// Test images: samples as a value, height fields in floats, and fields of waves with exact
/// normals.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"

namespace relief::test {

template <typename T>
std::vector<T> samples_of(const Image& image) {
    return std::get<std::vector<T>>(image.samples);
}

/// An image of one row with these samples.
template <typename Sample>
Image image_of(int channels, std::vector<Sample> samples,
               ColorSpace color_space = ColorSpace::data) {
    const int width = static_cast<int>(samples.size()) / channels;
    return {width, 1, channels, color_space, std::move(samples)};
}

template <typename Sample>
Image image_of(int width, int height, int channels, ColorSpace color_space,
               std::vector<Sample> samples) {
    return {width, height, channels, color_space, std::move(samples)};
}

inline constexpr FlatCode both_codes[] = {FlatCode::middle, FlatCode::half};
inline constexpr Wrap all_wraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

/// An image with one channel of floats; `at(column, row)` gives each value.
Image heights_of(int width, int height, const std::function<double(int, int)>& at);

/// Noise from 0 to 1 without symmetry, the same in every run.
Image rough(int width, int height, std::uint32_t seed = 12345);

/// Returns the same waves in a field of another resolution.
/// \param scale  texels of the original field per texel of the new one; both fields share their
///       upper left corner
inline std::vector<accuracy::HeightWave> resized_waves(std::vector<accuracy::HeightWave> waves,
                                                       double scale) {
    for (accuracy::HeightWave& wave : waves) {
        // The center of texel i is at (i + 0.5) * scale - 0.5.
        wave.phase += (wave.frequency.x + wave.frequency.y) * (scale - 1.0) / 2.0;
        wave.frequency *= scale;
        wave.amplitude /= scale;
    }
    return waves;
}

/// Returns the root mean square of the slopes at the texels of a field.
inline double rms_slope_of(int width, int height, const std::vector<accuracy::HeightWave>& waves) {
    double squares = 0.0;
    for (const glm::dvec3& normal : accuracy::wave_heights(width, height, waves).normals)
        squares += (normal.x * normal.x + normal.y * normal.y) / (normal.z * normal.z);
    return std::sqrt(squares / (static_cast<double>(width) * height));
}

/// Returns the waves with their amplitudes multiplied by a factor.
inline std::vector<accuracy::HeightWave> scaled_waves(std::vector<accuracy::HeightWave> waves,
                                                      double factor) {
    for (accuracy::HeightWave& wave : waves)
        wave.amplitude *= factor;
    return waves;
}

/// Returns tiling_waves() whose field has exactly this slope. Waves of equal frequency interfere,
/// so the slope of tiling_waves() is only approximate.
inline std::vector<accuracy::HeightWave> waves_with_slope(int side, int count, double shortest,
                                                          double rms_slope, std::uint32_t seed) {
    const std::vector<accuracy::HeightWave> waves =
        accuracy::tiling_waves(side, side, count, shortest, rms_slope, seed);
    return scaled_waves(waves, rms_slope / rms_slope_of(side, side, waves));
}

/// Returns the exact normals of a field as an image.
inline Image normals_image(int width, int height, const std::vector<accuracy::HeightWave>& waves) {
    const accuracy::BumpField field = accuracy::wave_heights(width, height, waves);
    Image image = make_image(width, height, 3, 32, ColorSpace::data);
    for (std::size_t i = 0; i < image.sample_count(); ++i)
        image.as<float>()[i] = static_cast<float>(field.normals[i / 3][static_cast<int>(i % 3)]);
    return image;
}

}  // namespace relief::test
