// SPDX-License-Identifier: Apache-2.0
// Noise after a blur, whose power is a Gaussian of the frequency: its detection, the strongest one
// that a map can contain, and its effect on the slopes of a kernel. Nothing throws.
// Tests: tests/mesh/bump/structured_noise_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bump/height_tile.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::array binomial = {0.375, 0.25, 0.0625};

/// Returns the response of the binomial filter along one axis.
double binomial_response(double frequency) {
    return 0.375 + 0.5 * portable::cos(frequency) + 0.125 * portable::cos(2.0 * frequency);
}

/// Returns every other texel of a smoothed tile.
HeightTile half_size(const HeightTile& tile) {
    const HeightTile smooth = filtered(tile, binomial);
    HeightTile half{tile.width / 2, tile.height / 2, tile.wrap, {}};
    for (int y = 0; y < half.height; ++y) {
        for (int x = 0; x < half.width; ++x)
            half.values.push_back(
                smooth.values[static_cast<std::size_t>(2 * y * tile.width + 2 * x)]);
    }
    return half;
}

}  // namespace

std::optional<NoiseSpectrum> PowerSpectrum::blurred_noise(double rounding,
                                                          const BlurEvidence& evidence) const {
    // The residual is that of the logarithm of the power.
    constexpr double max_residual = 0.35;
    constexpr double max_residual_ratio = 0.5;  ///< To the residual of the model of a surface.
    constexpr double max_variance = 6.0;        ///< Of the blur, in squared texels.
    std::vector<Band> bands = this->bands();
    // The corners of the spectrum contain white noise in addition, if there is any.
    const double floor = bands.empty() ? 0.0 : std::max(rounding * rounding, bands.back().power);
    while (!bands.empty() &&
           (bands.back().frequency > 0.5 * side_ || !(bands.back().power > 3.0 * floor)))
        bands.pop_back();
    // The fit of log(power) = level - variance * f^2 - exponent * log(f).
    struct Fit {
        double level = 0.0;
        double variance = 0.0;
        double residual = 0.0;
    };
    const auto squared_frequency = [&](const Band& band) {
        const double f = 2.0 * pi * band.frequency / side_;
        return f * f;
    };
    const auto fit = [&](std::size_t first, std::size_t end, double exponent) {
        double n = 0.0;
        double x = 0.0;
        double y = 0.0;
        double xx = 0.0;
        double xy = 0.0;
        double yy = 0.0;
        for (std::size_t i = first; i < end; ++i) {
            const double square = squared_frequency(bands[i]);
            const double log_power =
                portable::log(bands[i].power - floor) + 0.5 * exponent * portable::log(square);
            n += 1.0;
            x += square;
            y += log_power;
            xx += square * square;
            xy += square * log_power;
            yy += log_power * log_power;
        }
        const double slope = (n * xy - x * y) / (n * xx - x * x);
        const double level = (y - slope * x) / n;
        const double squares = yy - level * y - slope * xy;
        return Fit{level, -slope, std::sqrt(std::max(0.0, squares) / n)};
    };
    const auto is_noise = [&](std::size_t first, std::size_t end) {
        const Fit noise = fit(first, end, 0.0);
        // The range must include the decrease.
        constexpr double surface_exponent = 2.0;
        return noise.residual < max_residual && noise.variance < max_variance &&
               noise.variance * squared_frequency(bands[first]) < evidence.max_first_exponent &&
               noise.variance * squared_frequency(bands[end - 1]) > evidence.min_last_exponent &&
               noise.residual < max_residual_ratio * fit(first, end, surface_exponent).residual;
    };
    // Other detail or noise can dominate the lowest and the highest bands.
    for (std::size_t end = bands.size(); end >= evidence.min_bands; --end) {
        for (std::size_t first = 0; first + evidence.min_bands <= end; ++first) {
            if (!is_noise(first, end)) continue;
            const Fit noise = fit(first, end, 0.0);
            NoiseSpectrum result;
            result.side = side_;
            result.rings.clear();
            result.min_noise_only_frequency = std::sqrt(squared_frequency(bands[first]));
            for (int ring = 0; ring < side_; ++ring) {
                const double f = 2.0 * pi * ring / side_;
                result.rings.push_back(portable::exp(noise.level - noise.variance * f * f) + floor);
            }
            return result;
        }
    }
    return {};
}

NoiseSpectrum PowerSpectrum::max_blurred_noise(const OctaveDeviations& octaves) const {
    const std::vector<Band> bands = this->bands();
    NoiseSpectrum strongest = NoiseSpectrum::white(0.0);
    double max_slope = 0.0;
    for (const double blur : {1.0, 1.5, 2.0, 3.0, 4.0}) {
        const auto decrease = [&](double f) { return portable::exp(-blur * blur * f * f); };
        NoiseSpectrum noise;
        noise.side = side_;
        noise.rings.clear();
        for (int ring = 0; ring < side_; ++ring)
            noise.rings.push_back(decrease(2.0 * pi * ring / side_));
        double power = std::numeric_limits<double>::infinity();
        const OctaveDeviations of_noise = noise.octave_deviations();
        for (std::size_t i = 0; i < octaves.size(); ++i) {
            const double ratio = octaves[i] / of_noise[i];
            power = std::min(power, ratio * ratio);
        }
        // Beyond these frequencies the noise has hardly any power.
        const double max_frequency = 2.0 / blur;
        for (const Band& band : bands) {
            const double f = 2.0 * pi * band.frequency / side_;
            if (f < max_frequency) power = std::min(power, band.power / decrease(f));
        }
        const double slope = power / (blur * blur * blur * blur);
        if (!(slope > max_slope)) continue;
        max_slope = slope;
        for (double& ring : noise.rings)
            ring *= power;
        strongest = std::move(noise);
    }
    return strongest;
}

bool is_stationary(const NoiseSpectrum& noise, const OctaveDeviations& octaves, double rounding) {
    constexpr double min_ratio = 0.85;
    const OctaveDeviations expected = noise.octave_deviations();
    // Lower octaves contain other detail, and rounding hides blurred noise in the highest ones.
    for (std::size_t i = 0; i < octaves.size(); ++i) {
        if (expected[i] > 2.0 * rounding) return octaves[i] > min_ratio * expected[i];
    }
    return false;
}

std::optional<NoiseSpectrum> widely_blurred_noise(std::span<const HeightTile> tiles,
                                                  double rounding) {
    std::vector<HeightTile> halves;
    for (const HeightTile& tile : tiles)
        halves.push_back(half_size(tile));
    // The filter reduces independent rounding.
    const double half_rounding = 0.273 * rounding;
    // Smooth detail fills the lowest bands, so that the plateau cannot be seen.
    constexpr BlurEvidence evidence = {
        .min_bands = 3, .max_first_exponent = 3.0, .min_last_exponent = 4.0};
    const auto found = PowerSpectrum(halves).blurred_noise(half_rounding, evidence);
    if (!found || !is_stationary(*found, octave_deviations(halves), half_rounding))
        return std::nullopt;
    NoiseSpectrum noise;
    noise.side = tiles.front().width;
    noise.rings.clear();
    for (int ring = 0; ring < noise.side; ++ring) {
        const double f = 2.0 * pi * ring / noise.side;
        // The frequencies are halved, so the density is four times as high.
        const double power = 2.0 * f < pi ? 4.0 * found->at(2.0 * f, 0.0) : 0.0;
        const double response = binomial_response(std::min(f, 0.5 * pi));
        noise.rings.push_back(power / (response * response));
    }
    return noise;
}

double slope_variance(const GradientKernel& kernel, const NoiseSpectrum& noise) {
    // The mean over two directions between the axes, whose slopes have equal variances.
    constexpr int steps = 64;
    constexpr double near_axis = 0.9238795325112867;  // The cosine of pi / 8.
    constexpr double far_from_axis = 0.3826834323650898;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double f = pi * (i + 0.5) / steps;
        const auto slope = [&](double x, double y) {
            return slope_response(kernel, {f * x, f * y}) * f * x;
        };
        const double a = slope(near_axis, far_from_axis);
        const double b = slope(far_from_axis, near_axis);
        sum += f * noise.at(f, 0.0) * 0.5 * (a * a + b * b);
    }
    return sum * (pi / steps) / (2.0 * pi);
}

}  // namespace relief::detail
