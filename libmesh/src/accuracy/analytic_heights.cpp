// SPDX-License-Identifier: Apache-2.0
// Fields of waves with their true normals, in texels, computed in double from the formula itself.
// Bad sizes throw. Tests: tests/mesh/accuracy/analytic_surfaces_test.cpp.
#include "relief/mesh/analytic_heights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parallel.h"
#include "random.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

std::size_t texel_at(int width, int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
}

template <typename Code>
void code(std::span<const float> heights, double least, double range, std::span<Code> codes) {
    constexpr double largest = std::numeric_limits<Code>::max();
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double value = range > 0.0 ? (static_cast<double>(heights[i]) - least) / range : 0.0;
        codes[i] = static_cast<Code>(value * largest + 0.5);
    }
}

}  // namespace

HeightSample evaluate_waves(std::span<const HeightWave> waves, const glm::dvec2& place) {
    HeightSample sum;
    for (const HeightWave& wave : waves) {
        const double angle = glm::dot(wave.frequency, place) + wave.phase;
        sum.height += wave.amplitude * std::sin(angle);
        sum.slope += wave.amplitude * std::cos(angle) * wave.frequency;
    }
    return sum;
}

AnalyticHeights sampled_heights(int width, int height,
                                const std::function<HeightSample(const glm::dvec2& place)>& field) {
    AnalyticHeights result{make_image(width, height, 1, 32, ColorSpace::data), {}};
    const std::span<float> heights = result.heights.as<float>();
    result.normals.resize(heights.size());
    const auto rows = static_cast<std::size_t>(height);
    parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
        for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
            for (int column = 0; column < width; ++column) {
                const auto [value, slope] = field({column, row});
                const std::size_t texel = texel_at(width, column, row);
                heights[texel] = static_cast<float>(value);
                // Rows run downwards, the normal's y upwards.
                result.normals[texel] = glm::normalize(glm::dvec3(-slope.x, slope.y, 1.0));
            }
        }
    });
    return result;
}

AnalyticHeights wave_heights(int width, int height, std::span<const HeightWave> waves) {
    return sampled_heights(width, height,
                           [&](const glm::dvec2& place) { return evaluate_waves(waves, place); });
}

std::vector<HeightWave> tiling_waves(int width, int height, int count, double shortest,
                                     double rms_slope, std::uint32_t seed) {
    const double longest = std::max(width, height);
    if (width <= 0 || height <= 0 || count <= 0 || !(shortest > 0.0) || shortest > longest) {
        throw InvalidInput(fmt::format("no {} waves of {} texels or more tile {} x {} texels",
                                       count, shortest, width, height));
    }
    Random random(seed);
    std::vector<HeightWave> waves;
    while (waves.size() < static_cast<std::size_t>(count)) {
        const double direction = random.between(0.0, 2.0 * std::numbers::pi);
        const double length = shortest * std::pow(longest / shortest, random.between(0.0, 1.0));
        const glm::dvec2 times = glm::round(
            glm::dvec2(std::cos(direction) * width, std::sin(direction) * height) / length);
        const glm::dvec2 frequency = 2.0 * std::numbers::pi * times / glm::dvec2(width, height);
        const double steepness = glm::length(frequency);
        if (steepness == 0.0 || 2.0 * std::numbers::pi / steepness < shortest) continue;
        // A sine's slope has the mean square (amplitude * frequency)^2 / 2.
        const double amplitude = rms_slope * std::sqrt(2.0 / count) / steepness;
        waves.push_back({amplitude, frequency, random.between(0.0, 2.0 * std::numbers::pi)});
    }
    return waves;
}

CodedHeights coded_heights(const Image& heights, int bits) {
    if (heights.empty() || heights.channels != 1 || heights.bits() != 32 ||
        (bits != 8 && bits != 16)) {
        throw InvalidInput(fmt::format("{} channels of {} bits cannot be coded as heights of {}",
                                       heights.channels, heights.bits(), bits));
    }
    const std::span<const float> values = heights.as<float>();
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    CodedHeights coded{make_image(heights.width, heights.height, 1, bits, ColorSpace::data),
                       static_cast<double>(*greatest) - static_cast<double>(*least)};
    if (bits == 8)
        code(values, static_cast<double>(*least), coded.strength, coded.codes.as<std::uint8_t>());
    else
        code(values, static_cast<double>(*least), coded.strength, coded.codes.as<std::uint16_t>());
    return coded;
}

DirectionError normal_error(const Image& normals, const AnalyticHeights& reference, int margin) {
    if (normals.width != reference.heights.width || normals.height != reference.heights.height ||
        normals.channels != 3) {
        throw InvalidInput(fmt::format("normals of {} x {} texels and a truth of {} x {}",
                                       normals.width, normals.height, reference.heights.width,
                                       reference.heights.height));
    }
    const std::span<const float> samples = normals.as<float>();
    std::vector<glm::vec3> found;
    std::vector<glm::dvec3> expected;
    for (int row = margin; row < normals.height - margin; ++row) {
        for (int column = margin; column < normals.width - margin; ++column) {
            const std::size_t texel = texel_at(normals.width, column, row);
            found.emplace_back(samples[3 * texel], samples[3 * texel + 1], samples[3 * texel + 2]);
            expected.push_back(reference.normals[texel]);
        }
    }
    return direction_error(found, expected);
}

}  // namespace relief
