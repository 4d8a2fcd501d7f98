// SPDX-License-Identifier: Apache-2.0
// Noise that is not the same at every texel: offsets of whole rows or columns, as line scanners
// have, and noise whose strength depends on the height. Both are estimated from quantiles of high
// frequencies, like the noise of high_pass_noise(). Nothing throws.
// Tests: tests/mesh/bump/structured_noise_test.cpp.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "bump/height_tile.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

/// Applies the high-pass mask (1 -2 1) `times` times, and returns the absolute values. The gain for
/// white noise is 1.
std::vector<double> high_pass_of_line(std::vector<double> line, int times) {
    for (int i = 0; i < times && line.size() > 2; ++i) {
        for (std::size_t k = 0; k + 2 < line.size(); ++k)
            line[k] = line[k] - 2.0 * line[k + 1] + line[k + 2];
        line.resize(line.size() - 2);
    }
    // The square root of C(4 n, 2 n) for n = 2 and n = 3.
    const double gain = std::sqrt(times == 2 ? 70.0 : 924.0);
    for (double& value : line)
        value = std::abs(value) / gain;
    return line;
}

/// Returns the weights of the texels of a line for a wave along it: of `periods` periods, and equal
/// weights for none. The weighted sum of white noise has the deviation 1 / sqrt(length).
std::vector<double> wave_weights(int length, int periods, double phase) {
    std::vector<double> weights(static_cast<std::size_t>(length), 1.0 / length);
    for (int i = 0; i < length && periods > 0; ++i) {
        const double angle = 2.0 * std::numbers::pi * periods * (i + 0.5) / length + phase;
        weights[static_cast<std::size_t>(i)] *= std::numbers::sqrt2 * portable::cos(angle);
    }
    return weights;
}

/// Returns the weighted sum of the heights of each row, or column.
std::vector<double> line_sums(const HeightTile& tile, bool rows, std::span<const double> weights) {
    const auto width = static_cast<std::size_t>(tile.width);
    const auto height = static_cast<std::size_t>(tile.height);
    std::vector<double> sums(rows ? height : width, 0.0);
    if (rows) {
        // Eight sums at once, so that additions need not wait for each other.
        constexpr std::size_t lanes = 8;
        for (std::size_t y = 0; y < height; ++y) {
            const double* const line = tile.values.data() + y * width;
            std::array<double, lanes> parts{};
            std::size_t x = 0;
            for (; x + lanes <= width; x += lanes) {
                for (std::size_t lane = 0; lane < lanes; ++lane)
                    parts[lane] += weights[x + lane] * line[x + lane];
            }
            for (; x < width; ++x)
                parts[0] += weights[x] * line[x];
            sums[y] = ((parts[0] + parts[1]) + (parts[2] + parts[3])) +
                      ((parts[4] + parts[5]) + (parts[6] + parts[7]));
        }
        return sums;
    }
    for (std::size_t y = 0; y < height; ++y) {
        const double* const line = tile.values.data() + y * width;
        for (std::size_t x = 0; x < width; ++x)
            sums[x] += weights[y] * line[x];
    }
    return sums;
}

/// Returns the mean of each row, or column.
std::vector<double> line_means(const HeightTile& tile, bool rows) {
    return line_sums(tile, rows, wave_weights(rows ? tile.width : tile.height, 0, 0.0));
}

double line_deviation(std::span<const HeightTile> tiles, bool rows, double rounding) {
    std::vector<double> offsets;
    std::vector<double> smoother_offsets;
    std::vector<double> waves;
    std::vector<std::vector<double>> weights;
    const int length = rows ? tiles.front().width : tiles.front().height;
    for (const int periods : {2, 3, 4}) {
        for (const double phase : {0.0, std::numbers::pi / 2.0})
            weights.push_back(wave_weights(length, periods, phase));
    }
    for (const HeightTile& tile : tiles) {
        const std::vector<double> sums = line_means(tile, rows);
        for (const double value : high_pass_of_line(sums, 2))
            smoother_offsets.push_back(value);
        for (const double value : high_pass_of_line(sums, 3))
            offsets.push_back(value);
        for (const std::vector<double>& wave : weights) {
            for (const double value : high_pass_of_line(line_sums(tile, rows, wave), 3))
                waves.push_back(value);
        }
    }
    const double deviation = deviation_from_quantile(offsets);
    // Detail and white noise are as strong in waves along the lines. Detail along the lines is
    // smoother than independent offsets.
    constexpr double min_ratio = 2.5;
    constexpr double max_smoothness = 1.3;
    if (deviation < min_ratio * deviation_from_quantile(waves) || deviation < 1.2 * rounding ||
        deviation_from_quantile(smoother_offsets) > max_smoothness * deviation)
        return 0.0;
    // The lines are few, and the median is more accurate than a lower quantile. Detail is weaker.
    const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
    std::nth_element(offsets.begin(), middle, offsets.end());
    return *middle / 0.6745;
}

void remove_offsets(HeightTile& tile, bool rows, double deviation) {
    std::vector<double> sums = line_means(tile, rows);
    HeightTile smooth{static_cast<int>(sums.size()), 1, Wrap::clamp, sums};
    static constexpr std::array binomial = {0.375, 0.25, 0.0625};
    for (const int spacing : {1, 2, 4})
        smooth = filtered(smooth, binomial, spacing);
    // Edges along the lines are larger than offsets.
    const double max_offset = 3.0 * deviation;
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const auto line = static_cast<std::size_t>(rows ? y : x);
            tile.values[static_cast<std::size_t>(y * tile.width + x)] -=
                std::clamp(sums[line] - smooth.values[line], -max_offset, max_offset);
        }
    }
}

}  // namespace

LineNoise line_noise(std::span<const HeightTile> tiles, double rounding) {
    return {line_deviation(tiles, true, rounding), line_deviation(tiles, false, rounding)};
}

void remove_line_noise(HeightTile& tile, const LineNoise& noise) {
    if (noise.rows > 0.0) remove_offsets(tile, true, noise.rows);
    if (noise.columns > 0.0) remove_offsets(tile, false, noise.columns);
}

double NoiseByHeight::at(double height) const {
    if (height <= heights.front()) return deviations.front();
    if (height >= heights.back()) return deviations.back();
    const auto above = static_cast<std::size_t>(
        std::upper_bound(heights.begin(), heights.end(), height) - heights.begin());
    const double w = (height - heights[above - 1]) / (heights[above] - heights[above - 1]);
    return std::lerp(deviations[above - 1], deviations[above], w);
}

namespace {

/// A height and the magnitude of the noise there.
struct NoiseSample {
    float height;
    float magnitude;
};

/// Sorts samples by their heights, in time proportional to their number.
void sort_by_height(std::vector<NoiseSample>& samples) {
    constexpr unsigned digit_bits = 11;
    constexpr std::uint32_t digits = 1U << digit_bits;
    const auto key_of = [](float height) {
        const auto bits = std::bit_cast<std::uint32_t>(height + 0.0F);
        return bits ^ (bits >> 31 != 0 ? 0xffffffffU : 0x80000000U);
    };
    std::vector<NoiseSample> sorted(samples.size());
    for (unsigned shift = 0; shift < 32; shift += digit_bits) {
        std::array<std::uint32_t, digits + 1> begins{};
        for (const NoiseSample& sample : samples)
            ++begins[(key_of(sample.height) >> shift & (digits - 1)) + 1];
        for (std::uint32_t digit = 0; digit < digits; ++digit)
            begins[digit + 1] += begins[digit];
        for (const NoiseSample& sample : samples)
            sorted[begins[key_of(sample.height) >> shift & (digits - 1)]++] = sample;
        samples.swap(sorted);
    }
}

/// Returns heights and magnitudes at every other row.
std::vector<NoiseSample> noise_samples(std::span<const HeightTile> tiles) {
    static constexpr std::array binomial = {0.375, 0.25, 0.0625};
    std::vector<NoiseSample> samples;
    for (const HeightTile& tile : tiles) {
        const HeightTile smooth = filtered(filtered(tile, binomial), binomial, 2);
        const std::vector<double> magnitudes = high_pass(tile, 2);
        constexpr int margin = 2;  // Of high_pass().
        for (int y = margin; y < tile.height - margin; y += 2) {
            auto next = static_cast<std::size_t>((y - margin) * (tile.width - 2 * margin));
            for (int x = margin; x < tile.width - margin; ++x) {
                const auto texel = static_cast<std::size_t>(y * tile.width + x);
                samples.push_back({static_cast<float>(smooth.values[texel]),
                                   static_cast<float>(magnitudes[next++])});
            }
        }
    }
    return samples;
}

}  // namespace

std::optional<NoiseByHeight> noise_by_height(std::span<const HeightTile> tiles) {
    constexpr std::size_t classes = 6;
    constexpr std::size_t min_samples = 200;
    std::vector<NoiseSample> samples = noise_samples(tiles);
    if (samples.size() < classes * min_samples) return std::nullopt;
    sort_by_height(samples);
    NoiseByHeight noise;
    std::vector<double> tails;  // Ratios of deviations by the median and by the quantile.
    std::vector<double> magnitudes;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < classes; ++i) {
        std::size_t end = samples.size() * (i + 1) / classes;
        if (begin + min_samples > end) continue;
        // A flat ground is one class.
        while (end < samples.size() && samples[end].height == samples[end - 1].height)
            ++end;
        magnitudes.clear();
        for (std::size_t k = begin; k < end; ++k)
            magnitudes.push_back(samples[k].magnitude);
        const double deviation = deviation_from_quantile(magnitudes);
        // Half of a Gaussian lies within 0.6745 standard deviations.
        tails.push_back(smallest_of(magnitudes, magnitudes.size() / 2) / 0.6745 / deviation);
        noise.heights.push_back(samples[(begin + end) / 2].height);
        noise.deviations.push_back(deviation);
        begin = end;
    }
    constexpr std::size_t min_classes = 3;
    const std::size_t count = noise.heights.size();
    if (count < min_classes) return std::nullopt;
    const double max_deviation =
        *std::max_element(noise.deviations.begin(), noise.deviations.end());
    for (std::size_t i = 0; i < count; ++i) {
        // Detail is in few texels, and its distribution has a longer tail. A ground without noise
        // has any distribution.
        constexpr double max_tail = 1.4;
        constexpr double max_ground = 0.05;
        if (noise.deviations[i] > max_ground * max_deviation && !(tails[i] <= max_tail))
            return std::nullopt;
    }
    // The noise grows with the height, or with the depth if the map is inverted.
    constexpr double min_growth = 1.5;
    constexpr double tolerance = 1.1;
    const bool grows = noise.deviations.back() > noise.deviations.front();
    for (std::size_t i = 1; i < count; ++i) {
        const double low = noise.deviations[grows ? i - 1 : i];
        const double high = noise.deviations[grows ? i : i - 1];
        if (low > tolerance * high) return std::nullopt;
        if (!(noise.heights[i] > noise.heights[i - 1])) return std::nullopt;
    }
    const auto [min, max] = std::minmax(noise.deviations.front(), noise.deviations.back());
    if (max < min_growth * min) return std::nullopt;
    return noise;
}

}  // namespace relief::detail
