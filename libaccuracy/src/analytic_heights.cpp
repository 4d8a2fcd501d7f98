// SPDX-License-Identifier: Apache-2.0
// Computes fields of waves and other shapes with their exact normals, in double from the formula,
// in texels; and stores them with noise and in few bits, like heights in files.
#include "relief/accuracy/ground_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiment_parts.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief::accuracy {
using namespace relief::accuracy::detail;
using namespace relief::detail;

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

/// A height in texels and its derivatives to the right and downwards.
struct HeightSample {
    double height = 0.0;
    glm::dvec2 slope{};
};
using FieldFunction = std::function<HeightSample(const glm::dvec2& position)>;

HeightSample evaluate_waves(std::span<const HeightWave> waves, const glm::dvec2& position) {
    HeightSample sum;
    for (const HeightWave& wave : waves) {
        const double angle = glm::dot(wave.frequency, position) + wave.phase;
        sum.height += wave.amplitude * portable::sin(angle);
        sum.slope += wave.amplitude * portable::cos(angle) * wave.frequency;
    }
    return sum;
}

/// Samples a field, which is called from several threads, at the texel centers.
BumpField sampled_heights(int width, int height, const FieldFunction& field) {
    BumpField result;
    result.heights = make_image(width, height, 1, 32, ColorSpace::data);
    result.options.strength = 1.0;
    const std::span<float> heights = result.heights.as<float>();
    result.normals.resize(heights.size());
    const auto rows = static_cast<std::size_t>(height);
    parallel_for(rows, 16, [&](std::size_t begin, std::size_t end) {
        for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
            for (int column = 0; column < width; ++column) {
                const auto [value, slope] = field({column, row});
                const std::size_t texel = texel_at(width, column, row);
                heights[texel] = static_cast<float>(value);
                // Rows run downwards, but the y axis of normals points upwards.
                result.normals[texel] = glm::normalize(glm::dvec3(-slope.x, slope.y, 1.0));
            }
        }
    });
    return result;
}

}  // namespace

BumpField wave_heights(int width, int height, std::span<const HeightWave> waves) {
    return sampled_heights(
        width, height, [&](const glm::dvec2& position) { return evaluate_waves(waves, position); });
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
        const double length =
            shortest * portable::pow(longest / shortest, random.between(0.0, 1.0));
        const glm::dvec2 times = glm::round(
            glm::dvec2(portable::cos(direction) * width, portable::sin(direction) * height) /
            length);
        const glm::dvec2 frequency = 2.0 * std::numbers::pi * times / glm::dvec2(width, height);
        const double steepness = glm::length(frequency);
        if (steepness == 0.0 || 2.0 * std::numbers::pi / steepness < shortest) continue;
        // The mean square of the slope of a sine is (amplitude * frequency)^2 / 2.
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

std::vector<glm::dvec3> detail::directions_of(const Image& normals) {
    const std::span<const float> n = normals.as<float>();
    std::vector<glm::dvec3> directions(n.size() / 3);
    for (std::size_t i = 0; i < directions.size(); ++i)
        directions[i] = {n[3 * i], n[3 * i + 1], n[3 * i + 2]};
    return directions;
}

Image detail::angles_of(const Image& normals, std::span<const glm::dvec3> ground_truth) {
    if (normals.channels != 3 || normals.bits() != 32 ||
        normals.sample_count() != 3 * ground_truth.size()) {
        throw InvalidInput(fmt::format("a map of {} x {} texels of {} channels has no {} normals",
                                       normals.width, normals.height, normals.channels,
                                       ground_truth.size()));
    }
    Image angles = make_image(normals.width, normals.height, 1, 32, ColorSpace::data);
    const std::span<const float> n = normals.as<float>();
    const std::span<float> degrees = angles.as<float>();
    parallel_for(degrees.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 actual(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
            degrees[i] = static_cast<float>(degrees_between(actual, ground_truth[i]));
        }
    });
    return angles;
}

std::vector<float> detail::inner_angles(const Image& normals,
                                        std::span<const glm::dvec3> ground_truth, int margin) {
    const Image angles = angles_of(normals, ground_truth);
    const std::span<const float> all = angles.as<float>();
    std::vector<float> counted;
    for (int y = margin; y < angles.height - margin; ++y) {
        for (int x = margin; x < angles.width - margin; ++x) {
            const std::size_t texel = texel_at(angles.width, x, y);
            if (!std::isnan(ground_truth[texel].x)) counted.push_back(all[texel]);
        }
    }
    return counted;
}

ErrorStats detail::map_errors(const Image& normals, std::span<const glm::dvec3> ground_truth,
                              int margin) {
    return error_stats(inner_angles(normals, ground_truth, margin));
}

ErrorStats normal_error(const Image& normals, const BumpField& field, int margin) {
    return map_errors(normals, field.normals, margin);
}

namespace {

constexpr int waves_in_all = 24;

/// Waves of any length, which do not tile.
std::vector<HeightWave> open_waves(int size, const FieldRecipe& recipe) {
    Random random(recipe.seed);
    std::vector<HeightWave> waves;
    for (int i = 0; i < waves_in_all; ++i) {
        const double direction = random.between(0.0, 2.0 * std::numbers::pi);
        const double length =
            recipe.shortest * portable::pow(1.7 * size / recipe.shortest, random.between(0.0, 1.0));
        const double steepness = 2.0 * std::numbers::pi / length;
        const glm::dvec2 frequency =
            steepness * glm::dvec2(portable::cos(direction), portable::sin(direction));
        waves.push_back({recipe.rms_slope * std::sqrt(2.0 / waves_in_all) / steepness, frequency,
                         random.between(0.0, 2.0 * std::numbers::pi)});
    }
    return waves;
}

/// Bumps (1 - r^2)^3 of random heights in the cells of a lattice that divides the size.
FieldFunction domes(int width, int height, const FieldRecipe& recipe) {
    const glm::dvec2 size(width, height);
    const glm::dvec2 cells = glm::max(glm::round(size / recipe.shortest), glm::dvec2(1.0));
    const glm::dvec2 cell = size / cells;
    const double radius = 0.48 * std::min(cell.x, cell.y);
    return [=](const glm::dvec2& position) -> HeightSample {
        const glm::dvec2 index = glm::floor(position / cell);
        Random random(recipe.seed + static_cast<std::uint32_t>(index.x + index.y * cells.x));
        // The RMS slope of the shape is about its height divided by its radius.
        const double peak = recipe.rms_slope * radius * random.between(0.5, 1.5);
        const glm::dvec2 from_center = position - (index + 0.5) * cell;
        const double inside = 1.0 - glm::dot(from_center, from_center) / (radius * radius);
        if (inside <= 0.0) return {};
        return {peak * inside * inside * inside,
                peak * 3.0 * inside * inside * -2.0 * from_center / (radius * radius)};
    };
}

/// Roofs along both axes with equal slopes and ridges between texels.
FieldFunction creases(int width, int height, const FieldRecipe& recipe) {
    const glm::dvec2 size(width, height);
    const glm::dvec2 period = size / glm::max(glm::round(size / recipe.shortest), glm::dvec2(1.0));
    return [=](const glm::dvec2& position) -> HeightSample {
        const glm::dvec2 phase = glm::fract((position + 0.37) / period) - 0.5;
        const glm::dvec2 side(phase.x < 0.0 ? 1.0 : -1.0, phase.y < 0.0 ? 1.0 : -1.0);
        const double slope = recipe.rms_slope / std::sqrt(2.0);
        const glm::dvec2 roof = slope * period * (0.5 - glm::abs(phase));
        return {roof.x + roof.y, slope * side};
    };
}

/// Level ground whose height follows a long wave in steps, with gentle waves added.
FieldFunction terraces(int width, int height, const FieldRecipe& recipe) {
    const std::vector<HeightWave> shape =
        tiling_waves(width, height, 6, 2.0 * recipe.shortest, 1.0, recipe.seed);
    const std::vector<HeightWave> ground =
        tiling_waves(width, height, 8, recipe.shortest, 0.25, recipe.seed + 1);
    const double between = recipe.shortest;
    const double wall = 4.0 * recipe.rms_slope;
    const auto level = [=](const glm::dvec2& position) {
        return std::floor(evaluate_waves(shape, position).height / between + 0.3);
    };
    return [=](const glm::dvec2& position) -> HeightSample {
        HeightSample result = evaluate_waves(ground, position);
        const double own = level(position);
        result.height += wall * own;
        // A texel whose neighbor is on another level is beside a wall and has no normal.
        for (const glm::dvec2& step :
             {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
            if (level(position + step) != own)
                result.slope = glm::dvec2(std::numeric_limits<double>::quiet_NaN());
        }
        return result;
    };
}

/// Long waves everywhere, and short ones weighted by a smooth mask along x.
FieldFunction mixed(int width, int height, const FieldRecipe& recipe) {
    const double longest = std::max(width, height);
    const std::vector<HeightWave> wide =
        tiling_waves(width, height, 8, longest / 4.0, recipe.rms_slope, recipe.seed);
    const std::vector<HeightWave> fine = tiling_waves(width, height, waves_in_all, recipe.shortest,
                                                      recipe.rms_slope, recipe.seed + 1);
    return [=](const glm::dvec2& position) -> HeightSample {
        const double angle = 2.0 * std::numbers::pi * position.x / width;
        const double s = 0.5 - 0.5 * portable::cos(angle);
        const double mask = s * s;
        const double steepness =
            2.0 * s * 0.5 * portable::sin(angle) * 2.0 * std::numbers::pi / width;
        HeightSample result = evaluate_waves(wide, position);
        const HeightSample detail = evaluate_waves(fine, position);
        result.height += mask * detail.height;
        result.slope += mask * detail.slope + glm::dvec2(steepness * detail.height, 0.0);
        return result;
    };
}

FieldFunction shape_of(int width, int height, const FieldRecipe& recipe) {
    switch (recipe.shape) {
        case FieldShape::waves: {
            auto waves = tiling_waves(width, height, waves_in_all, recipe.shortest,
                                      recipe.rms_slope, recipe.seed);
            return [waves](const glm::dvec2& position) { return evaluate_waves(waves, position); };
        }
        case FieldShape::open: {
            auto waves = open_waves(std::max(width, height), recipe);
            return [waves](const glm::dvec2& position) { return evaluate_waves(waves, position); };
        }
        case FieldShape::domes:
            return domes(width, height, recipe);
        case FieldShape::creases:
            return creases(width, height, recipe);
        case FieldShape::terraces:
            return terraces(width, height, recipe);
        case FieldShape::mixed:
            break;
    }
    return mixed(width, height, recipe);
}

void add_noise(std::span<float> heights, const FieldRecipe& recipe) {
    Random random(recipe.seed + 77);
    for (float& height : heights)
        height = static_cast<float>(static_cast<double>(height) + recipe.noise * random.normal());
}

/// Rounds heights to the 11 bits of half floats; the range of their exponents is ignored.
void round_to_half(std::span<float> heights) {
    for (float& height : heights) {
        int exponent = 0;
        const double fraction = std::frexp(static_cast<double>(height), &exponent);
        height = static_cast<float>(std::ldexp(std::nearbyint(fraction * 2048.0), exponent - 11));
    }
}

/// Converts codes by a function.
template <typename From, typename To>
Image recoded(const Image& codes, int (*recode)(int)) {
    Image result = make_image(codes.width, codes.height, 1, 8 * sizeof(To), ColorSpace::data);
    std::ranges::transform(codes.as<From>(), result.as<To>().begin(),
                           [&](int code) { return static_cast<To>(recode(code)); });
    return result;
}

void store(Image heights, FieldCoding coding, BumpField& field) {
    if (coding == FieldCoding::float16) round_to_half(heights.as<float>());
    if (coding == FieldCoding::float32 || coding == FieldCoding::float16) {
        field.heights = std::move(heights);
        return;
    }
    CodedHeights coded = coded_heights(heights, coding == FieldCoding::bits16 ? 16 : 8);
    field.options.strength = coded.strength;
    field.heights = std::move(coded.codes);
    if (coding == FieldCoding::bits8_in_16) {
        field.heights = recoded<std::uint8_t, std::uint16_t>(field.heights,
                                                             [](int code) { return code * 257; });
    }
    if (coding == FieldCoding::bits8_dim) {
        // By way of 16 bits, so that nothing is rounded twice to 8.
        coded = coded_heights(heights, 16);
        field.options.strength = coded.strength * 255.0 / 24.0;
        field.heights = recoded<std::uint16_t, std::uint8_t>(
            coded.codes, [](int code) { return 100 + (code * 24 + 32767) / 65535; });
    }
}

}  // namespace

BumpField make_bump_field(const FieldRecipe& original, int width, int height) {
    if (width < 8 || height < 8)
        throw InvalidInput(
            fmt::format("the field has {} x {} texels, which are too few", width, height));
    FieldRecipe recipe = original;
    recipe.shortest = std::min(recipe.shortest, 0.5 * std::max(width, height));
    BumpField field = sampled_heights(width, height, shape_of(width, height, recipe));
    field.options.wrap = recipe.shape == FieldShape::open ? Wrap::clamp : Wrap::repeat;
    if (recipe.noise > 0.0) add_noise(field.heights.as<float>(), recipe);
    store(std::move(field.heights), recipe.coding, field);
    return field;
}

std::span<const FieldRecipe> tuning_fields() {
    using enum FieldShape;
    using enum FieldCoding;
    static constexpr FieldRecipe all[] = {
        // name, shape, shortest, rms_slope, coding, noise, seed
        {"smooth, float", waves, 32, 0.3, float32, 0, 1},
        {"smooth, half float", waves, 32, 0.3, float16, 0, 2},
        {"smooth, 16 bit", waves, 32, 0.3, bits16, 0, 3},
        {"smooth, 8 bit", waves, 32, 0.3, bits8, 0, 4},
        {"smooth, 8 bit in 16", waves, 32, 0.3, bits8_in_16, 0, 5},
        {"smooth, 25 codes of 8 bit", waves, 32, 0.3, bits8_dim, 0, 6},
        {"very smooth, float", waves, 120, 0.3, float32, 0, 7},
        {"very smooth, 16 bit", waves, 120, 0.3, bits16, 0, 8},
        {"very smooth, 8 bit", waves, 120, 0.3, bits8, 0, 9},
        {"very smooth, 25 codes of 8 bit", waves, 120, 0.3, bits8_dim, 0, 10},
        {"detailed, float", waves, 4, 0.3, float32, 0, 11},
        {"detailed, 16 bit", waves, 4, 0.3, bits16, 0, 12},
        {"detailed, 8 bit", waves, 4, 0.3, bits8, 0, 13},
        {"detailed, 25 codes of 8 bit", waves, 4, 0.3, bits8_dim, 0, 14},
        {"finest detail, float", waves, 3, 0.3, float32, 0, 15},
        {"flat relief, 8 bit", waves, 16, 0.01, bits8, 0, 16},
        {"steep, float", waves, 16, 2.0, float32, 0, 17},
        {"steep, 8 bit", waves, 16, 2.0, bits8, 0, 18},
        {"noise 0.003, float", waves, 32, 0.3, float32, 0.003, 19},
        {"noise 0.03, float", waves, 32, 0.3, float32, 0.03, 20},
        {"noise 0.3, float", waves, 32, 0.3, float32, 0.3, 21},
        {"noise 0.03, detailed, 16 bit", waves, 4, 0.3, bits16, 0.03, 22},
        {"noise 0.3, 16 bit", waves, 64, 0.3, bits16, 0.3, 23},
        {"noise 0.1, 8 bit", waves, 32, 0.3, bits8, 0.1, 24},
        {"open, float", open, 24, 0.3, float32, 0, 25},
        {"open, 8 bit", open, 24, 0.3, bits8, 0, 26},
        {"open, noise 0.1, 16 bit", open, 24, 0.3, bits16, 0.1, 27},
        {"domes, float", domes, 32, 0.4, float32, 0, 28},
        {"domes, 8 bit", domes, 32, 0.4, bits8, 0, 29},
        {"domes, noise 0.05, 16 bit", domes, 32, 0.4, bits16, 0.05, 30},
        {"creases, float", creases, 32, 0.5, float32, 0, 31},
        {"creases, 8 bit", creases, 32, 0.5, bits8, 0, 32},
        {"terraces, float", terraces, 16, 1.0, float32, 0, 33},
        {"terraces, 16 bit", terraces, 16, 1.0, bits16, 0, 34},
        {"terraces, 8 bit", terraces, 16, 1.0, bits8, 0, 35},
        {"mixed, float", mixed, 4, 0.3, float32, 0, 36},
        {"mixed, 16 bit", mixed, 4, 0.3, bits16, 0, 37},
        {"mixed, 8 bit", mixed, 4, 0.3, bits8, 0, 38},
        {"mixed, noise 0.05, float", mixed, 6, 0.3, float32, 0.05, 39},
    };
    return all;
}

std::span<const FieldRecipe> evaluation_fields() {
    using enum FieldShape;
    using enum FieldCoding;
    static constexpr FieldRecipe all[] = {
        // name, shape, shortest, rms_slope, coding, noise, seed
        {"waves of 26, float", waves, 26, 0.15, float32, 0, 501},
        {"waves of 14, half float", waves, 14, 0.4, float16, 0, 502},
        {"waves of 60, 16 bit", waves, 60, 0.25, bits16, 0, 503},
        {"waves of 9, 16 bit", waves, 9, 0.2, bits16, 0, 504},
        {"waves of 40, 8 bit", waves, 40, 0.2, bits8, 0, 505},
        {"waves of 15, 8 bit", waves, 15, 0.9, bits8, 0, 506},
        {"waves of 6, 8 bit", waves, 6, 0.25, bits8, 0, 507},
        {"waves of 70, 8 bit in 16", waves, 70, 0.3, bits8_in_16, 0, 508},
        {"waves of 28, 25 codes", waves, 28, 0.7, bits8_dim, 0, 509},
        {"waves of 3.5, float", waves, 3.5, 0.5, float32, 0, 510},
        {"waves of 36, noise 0.02, float", waves, 36, 0.2, float32, 0.02, 511},
        {"waves of 12, noise 0.15, float", waves, 12, 0.5, float32, 0.15, 512},
        {"waves of 100, noise 2, float", waves, 100, 0.6, float32, 2.0, 513},
        {"waves of 16, noise 0.01, 16 bit", waves, 16, 0.12, bits16, 0.01, 514},
        {"waves of 44, noise 0.08, 8 bit", waves, 44, 0.25, bits8, 0.08, 515},
        {"open from 14, 16 bit", open, 14, 0.3, bits16, 0, 516},
        {"open from 18, 8 bit", open, 18, 0.4, bits8, 0, 517},
        {"open from 50, 25 codes", open, 50, 0.3, bits8_dim, 0, 518},
        {"open from 9, noise 0.05, float", open, 9, 0.3, float32, 0.05, 519},
        {"domes of 26, 16 bit", domes, 26, 0.6, bits16, 0, 520},
        {"domes of 44, 8 bit", domes, 44, 0.5, bits8, 0, 521},
        {"domes of 36, noise 0.1, float", domes, 36, 0.4, float32, 0.1, 522},
        {"creases of 24, 16 bit", creases, 24, 0.6, bits16, 0, 523},
        {"creases of 40, 8 bit", creases, 40, 0.4, bits8, 0, 524},
        {"terraces of 20, float", terraces, 20, 0.7, float32, 0, 525},
        {"terraces of 30, 8 bit", terraces, 30, 1.5, bits8, 0, 526},
        {"mixed from 5, 16 bit", mixed, 5, 0.4, bits16, 0, 527},
        {"mixed from 7, 8 bit", mixed, 7, 0.4, bits8, 0, 528},
        {"mixed from 10, noise 0.07, 16 bit", mixed, 10, 0.25, bits16, 0.07, 529},
    };
    return all;
}

}  // namespace relief::accuracy
