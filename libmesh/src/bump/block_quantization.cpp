// SPDX-License-Identifier: Apache-2.0
// The quantization of JPEG: blocks of 8 x 8 texels, whose coefficients of the discrete cosine
// transform are multiples of a step each [ITU-T T.81]. The steps are estimated from decoded
// heights. The removal of the blocks projects smoothed heights onto the intervals of the
// coefficients, as in [Zakhor 1992]. Nothing throws.
// Tests: tests/mesh/bump/structured_noise_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bump/height_tile.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

constexpr int block = 8;
using Block = std::array<double, std::size_t{block} * block>;

/// Multiplies the rows of a block by the matrix of the transform, or by its transpose, and stores
/// the result transposed. Two calls transform both axes.
Block transform_rows(const Block& from, bool inverse) {
    static const Block matrix = [] {
        Block result{};
        for (int u = 0; u < block; ++u) {
            for (int x = 0; x < block; ++x) {
                const double gain = u == 0 ? std::sqrt(1.0 / block) : std::sqrt(2.0 / block);
                result[static_cast<std::size_t>(u * block + x)] =
                    gain * portable::cos((2 * x + 1) * u * std::numbers::pi / (2 * block));
            }
        }
        return result;
    }();
    Block to{};
    for (std::size_t row = 0; row < block; ++row) {
        for (std::size_t u = 0; u < block; ++u) {
            double sum = 0.0;
            for (std::size_t x = 0; x < block; ++x)
                sum += from[row * block + x] * matrix[inverse ? x * block + u : u * block + x];
            to[u * block + row] = sum;
        }
    }
    return to;
}

Block transformed(const Block& from, bool inverse) {
    return transform_rows(transform_rows(from, inverse), inverse);
}

Block read_block(const HeightTile& tile, int x, int y) {
    Block values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int column = x + static_cast<int>(i) % block;
        const int row = y + static_cast<int>(i) / block;
        values[i] = tile.values[static_cast<std::size_t>(row * tile.width + column)];
    }
    return values;
}

void write_block(HeightTile& tile, int x, int y, const Block& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int column = x + static_cast<int>(i) % block;
        const int row = y + static_cast<int>(i) / block;
        tile.values[static_cast<std::size_t>(row * tile.width + column)] = values[i];
    }
}

/// Calls with_block(x, y) for all blocks inside of a tile, the first one at (`first`, `first`).
template <typename WithBlock>
void for_blocks(const HeightTile& tile, int first, const WithBlock& with_block) {
    for (int y = first; y + block <= tile.height; y += block) {
        for (int x = first; x + block <= tile.width; x += block)
            with_block(x, y);
    }
}

/// JPEG stores codes minus 128. The offset is part of the constant coefficient.
double stored_offset(std::size_t coefficient, double code) {
    return coefficient == 0 ? 128.0 * block * code : 0.0;
}

constexpr double max_step = 255.0;

/// The distance from a multiple of a step within which a coefficient counts as one, in codes.
/// Rounding to codes changes a coefficient by 0.3 codes.
double tolerance_of(double step) {
    return std::min(1.0, 0.25 * step);
}

/// Returns the probability that different values are as close to multiples of a step as these
/// coefficients are, if they have no step.
double chance_of(std::span<const double> coefficients, double step) {
    std::vector<double> multiples;
    for (const double value : coefficients)
        multiples.push_back(std::round(std::abs(value) / step));
    std::sort(multiples.begin(), multiples.end());
    const auto count = std::unique(multiples.begin(), multiples.end()) - multiples.begin();
    return portable::pow(2.0 * tolerance_of(step) / step, static_cast<double>(count));
}

/// Returns the largest integer whose multiples are close to the coefficients, in codes. 0 if there
/// is none.
double common_step(std::span<const double> coefficients) {
    constexpr double min_step = 2.0;
    constexpr double max_misfits = 0.1;
    const auto count = static_cast<double>(coefficients.size());
    for (double step = max_step; step >= min_step; step -= 1.0) {
        const double tolerance = tolerance_of(step);
        double misfits = 0.0;
        for (const double value : coefficients) {
            if (std::abs(value - step * std::round(value / step)) > tolerance) misfits += 1.0;
            if (misfits > max_misfits * count) break;
        }
        if (misfits <= max_misfits * count) return step;
    }
    return 0.0;
}

using Coefficients = std::array<std::vector<double>, std::size_t{block} * block>;

/// Appends the coefficients of the blocks of a tile, in codes.
void append_coefficients(const HeightTile& tile, double code, Coefficients& coefficients) {
    constexpr std::size_t max_samples = 400;
    for_blocks(tile, 0, [&](int x, int y) {
        const Block stored = transformed(read_block(tile, x, y), false);
        for (std::size_t i = 0; i < stored.size(); ++i) {
            const double value = (stored[i] - stored_offset(i, code)) / code;
            // Smaller coefficients can result from rounding to codes.
            constexpr double min_value = 2.5;
            if (std::abs(value) > min_value && coefficients[i].size() < max_samples)
                coefficients[i].push_back(value);
        }
    });
}

/// Returns nullopt if too few coefficients are multiples of a step.
std::optional<BlockQuantization> quantization_of(const Coefficients& coefficients, double code) {
    constexpr std::size_t min_samples = 20;
    constexpr double min_coarse_step = 3.0;
    constexpr double max_chance = 1e-3;
    BlockQuantization result;
    int tested = 0;
    int coarse = 0;
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
        if (coefficients[i].size() < min_samples) {
            result.steps[i] = max_step * code;
            continue;
        }
        const double step = common_step(coefficients[i]);
        result.steps[i] = step * code;
        // A few values are multiples of some step by chance, as in a map of equal slopes.
        if (step >= min_coarse_step && chance_of(coefficients[i], step) > max_chance) continue;
        tested += 1;
        if (step >= min_coarse_step) coarse += 1;
    }
    // Heights without blocks have no coarse step.
    constexpr int min_coarse = 3;
    if (coarse < min_coarse || 2 * coarse < tested) return std::nullopt;
    return result;
}

}  // namespace

std::optional<BlockQuantization> block_quantization(std::span<const HeightTile> tiles,
                                                    double code) {
    Coefficients coefficients;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        append_coefficients(tiles[i], code, coefficients);
        // Most maps have no blocks, which a few of the tiles show.
        constexpr std::size_t min_tiles = 3;
        if (i + 1 == min_tiles && tiles.size() >= 3 * min_tiles &&
            !quantization_of(coefficients, code))
            return std::nullopt;
    }
    return quantization_of(coefficients, code);
}

void remove_blocks(HeightTile& tile, const BlockQuantization& quantization) {
    static constexpr std::array binomial = {0.375, 0.25, 0.0625};
    const HeightTile stored = tile;
    for (const int spacing : {1, 2, 4, 2, 1, 1}) {
        tile = filtered(tile, binomial, spacing);
        for_blocks(tile, 0, [&](int x, int y) {
            const Block limits = transformed(read_block(stored, x, y), false);
            Block values = transformed(read_block(tile, x, y), false);
            for (std::size_t i = 0; i < values.size(); ++i) {
                const double half = 0.5 * quantization.steps[i];
                values[i] = std::clamp(values[i], limits[i] - half, limits[i] + half);
            }
            write_block(tile, x, y, transformed(values, true));
        });
    }
}

void add_lost_detail(HeightTile& tile, const BlockQuantization& quantization, std::uint32_t seed) {
    // Coefficients that are always 0 belong to detail that the map hardly has.
    const double max_lost_step =
        0.99 * *std::max_element(quantization.steps.begin(), quantization.steps.end());
    Random random(seed);
    for_blocks(tile, 0, [&](int x, int y) {
        Block values = transformed(read_block(tile, x, y), false);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double step = quantization.steps[i];
            if (step < max_lost_step) values[i] += step * random.between(-0.5, 0.5);
        }
        write_block(tile, x, y, transformed(values, true));
    });
}

void quantize_blocks(HeightTile& tile, const BlockQuantization& quantization, double code) {
    // The blocks are shifted, since remainders of the stored ones can be left.
    for_blocks(tile, block / 2, [&](int x, int y) {
        Block values = transformed(read_block(tile, x, y), false);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double step = quantization.steps[i];
            const double offset = stored_offset(i, code);
            if (step > 0.0) values[i] = offset + step * std::round((values[i] - offset) / step);
        }
        write_block(tile, x, y, transformed(values, true));
    });
}

}  // namespace relief::detail
