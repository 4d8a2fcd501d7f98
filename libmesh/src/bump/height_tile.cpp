// SPDX-License-Identifier: Apache-2.0
// Filters and noise estimators for small height fields: derivatives of high order that do not cross
// step edges (essentially non-oscillatory, after [Harten et al. 1987]), the removal of outliers,
// and noise estimates by high-pass masks, after [Immerkaer 1996]. Nothing throws.
// Tests: tests/mesh/bump/kernel_choice_test.cpp.
#include "bump/height_tile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/texel_loops.h"
#include "parallel.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

/// Returns a sample of a line, also beyond its ends.
double sample_at(const double* line, std::ptrdiff_t stride, int index, int count, Wrap wrap) {
    if (wrap != Wrap::clamp) return line[place_within(index, count, wrap) * stride];
    return reflected(index, count, [&](int at) { return line[at * stride]; });
}

/// Copies a line of a tile and extends it beyond both ends. Element `margin` of the result is the
/// first element of the line.
void read_line(const double* line, std::ptrdiff_t stride, int count, Wrap wrap, int margin,
               std::vector<double>& padded) {
    padded.resize(static_cast<std::size_t>(count + 2 * margin));
    for (int i = 0; i < count; ++i)
        padded[static_cast<std::size_t>(i + margin)] = line[i * stride];
    for (int i = 1; i <= margin; ++i) {
        padded[static_cast<std::size_t>(margin - i)] = sample_at(line, stride, -i, count, wrap);
        padded[static_cast<std::size_t>(margin + count - 1 + i)] =
            sample_at(line, stride, count - 1 + i, count, wrap);
    }
}

/// Calls process_line(first index, stride, count, wrap, buffer) for all rows or for all columns.
template <typename WithLine>
void for_lines(const HeightTile& tile, bool rows, const WithLine& process_line) {
    const int lines = rows ? tile.height : tile.width;
    parallel_for(static_cast<std::size_t>(lines), 16, [&](std::size_t begin, std::size_t end) {
        std::vector<double> padded;
        for (std::size_t line = begin; line < end; ++line) {
            const std::size_t first = rows ? line * static_cast<std::size_t>(tile.width) : line;
            process_line(first, rows ? 1 : tile.width, rows ? tile.width : tile.height,
                         rows ? tile.wrap.x : tile.wrap.y, padded);
        }
    });
}

/// Applies the filter along the rows.
void filter_rows(HeightTile& tile, std::span<const double> weights, int spacing) {
    const int margin = static_cast<int>(weights.size() - 1) * spacing;
    for_lines(tile, true,
              [&](std::size_t first, std::ptrdiff_t stride, int count, Wrap wrap,
                  std::vector<double>& padded) {
                  double* const line = tile.values.data() + first;
                  read_line(line, stride, count, wrap, margin, padded);
                  const double* const center = padded.data() + margin;
                  for (int i = 0; i < count; ++i) {
                      double sum = weights[0] * center[i];
                      for (std::size_t k = 1; k < weights.size(); ++k) {
                          const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(k) * spacing;
                          sum += weights[k] * (center[i - offset] + center[i + offset]);
                      }
                      line[i] = sum;
                  }
              });
}

/// Applies the filter along the columns, one whole row at a time.
void filter_columns(HeightTile& tile, std::span<const double> weights, int spacing) {
    const int margin = static_cast<int>(weights.size() - 1) * spacing;
    const auto width = static_cast<std::size_t>(tile.width);
    const auto row_at = [&](const std::vector<double>& rows, int row) {
        return rows.data() + static_cast<std::size_t>(row) * width;
    };
    std::vector<double> padded(static_cast<std::size_t>(tile.height + 2 * margin) * width);
    for (int row = -margin; row < tile.height + margin; ++row) {
        double* const to = padded.data() + static_cast<std::size_t>(row + margin) * width;
        if (row >= 0 && row < tile.height) {
            std::copy_n(row_at(tile.values, row), width, to);
            continue;
        }
        for (std::size_t x = 0; x < width; ++x)
            to[x] = sample_at(tile.values.data() + x, tile.width, row, tile.height, tile.wrap.y);
    }
    for (int row = 0; row < tile.height; ++row) {
        double* const to = tile.values.data() + static_cast<std::size_t>(row) * width;
        const double* const center = row_at(padded, row + margin);
        for (std::size_t x = 0; x < width; ++x)
            to[x] = weights[0] * center[x];
        for (std::size_t k = 1; k < weights.size(); ++k) {
            const int offset = static_cast<int>(k) * spacing;
            const double* const above = row_at(padded, row + margin - offset);
            const double* const below = row_at(padded, row + margin + offset);
            for (std::size_t x = 0; x < width; ++x)
                to[x] += weights[k] * (above[x] + below[x]);
        }
    }
}

constexpr int max_radius = 6;  ///< Half the maximum order of the slopes.

/// Returns the weights of h[k] - h[-k] in central differences of order 2 m, as [m][k].
std::array<std::array<double, max_radius + 1>, max_radius + 1> central_weights() {
    std::array<std::array<double, max_radius + 1>, max_radius + 1> weights{};
    for (int m = 1; m <= max_radius; ++m) {
        double ratio = 1.0;  // (m!)^2 / ((m-k)! (m+k)!)
        for (int k = 1; k <= m; ++k) {
            ratio *= static_cast<double>(m - k + 1) / (m + k);
            weights[static_cast<std::size_t>(m)][static_cast<std::size_t>(k)] =
                (k % 2 == 1 ? 1.0 : -1.0) * ratio / k;
        }
    }
    return weights;
}

/// Returns true if the difference of line[0] and line[1] is at least `min_height` and more than
/// `times` times as large as all differences near it.
bool is_step_edge(const double* line, double min_height, double times) {
    constexpr int near = 4;
    const double step = std::abs(line[1] - line[0]);
    if (step < min_height || step == 0.0) return false;
    double max_difference = 0.0;
    for (int k = 1; k <= near; ++k) {
        max_difference = std::max(
            {max_difference, std::abs(line[k + 1] - line[k]), std::abs(line[1 - k] - line[-k])});
    }
    return step > times * max_difference;
}

/// Computes the slope at line[0] from at most `left` and `right` texels on both sides: a central
/// difference, or a one-sided one beside a step edge.
double slope_at(const double* line, int left, int right) {
    static const auto weights = central_weights();
    const int m = std::min(left, right);
    if (m > 0) {
        double slope = 0.0;
        for (int k = 1; k <= m; ++k)
            slope += weights[static_cast<std::size_t>(m)][static_cast<std::size_t>(k)] *
                     (line[k] - line[-k]);
        return slope;
    }
    const int side = right > 0 ? 1 : -1;
    const int room = std::max(left, right);
    if (room == 0) return 0.0;
    if (room == 1) return side * (line[side] - line[0]);
    return side * (2.0 * (line[side] - line[0]) - 0.5 * (line[2 * side] - line[0]));
}

using Neighbors = std::array<double, 8>;

/// Returns the eight neighbors of an interior texel. Opposite neighbors are 4 elements apart.
Neighbors neighbors_at(const HeightTile& tile, int x, int y) {
    constexpr int neighbors[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                     {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    Neighbors result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
        const int at = (y + neighbors[i][1]) * tile.width + x + neighbors[i][0];
        result[i] = tile.values[static_cast<std::size_t>(at)];
    }
    return result;
}

/// Returns the median of the four heights of a texel above the lines between opposite neighbors.
double height_above_neighbors(const Neighbors& neighbors, double value) {
    std::array<double, 4> above{};
    for (std::size_t i = 0; i < 4; ++i)
        above[i] = value - 0.5 * (neighbors[i] + neighbors[i + 4]);
    std::sort(above.begin(), above.end());
    return 0.5 * (above[1] + above[2]);
}

/// Performs one pass of remove_outliers().
std::vector<double> remove_isolated_outliers(HeightTile& tile, double min_height) {
    // Neither Gaussian noise nor detail that a kernel can resolve exceeds this limit.
    constexpr double max_deviations = 8.0;
    // Corners and ends of lines have neighbors of similar height. Along an edge, the neighbors also
    // rise above their own neighborhoods.
    constexpr double max_similar_share = 0.4;
    HeightTile heights_above{tile.width, tile.height, tile.wrap,
                             std::vector<double>(tile.values.size(), 0.0)};
    std::vector<double>& above = heights_above.values;
    std::vector<double> magnitudes;
    for (int y = 1; y + 1 < tile.height; ++y) {
        for (int x = 1; x + 1 < tile.width; ++x) {
            const auto texel = static_cast<std::size_t>(y * tile.width + x);
            above[texel] = height_above_neighbors(neighbors_at(tile, x, y), tile.values[texel]);
            magnitudes.push_back(std::abs(above[texel]));
        }
    }
    if (magnitudes.empty()) return {};
    const auto center = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
    std::nth_element(magnitudes.begin(), center, magnitudes.end());
    // The median absolute value of a Gaussian is 0.6745 standard deviations.
    const double limit = std::max(min_height, max_deviations * *center / 0.6745);
    const HeightTile before = tile;
    std::vector<double> heights;
    for (int y = 1; y + 1 < tile.height; ++y) {
        for (int x = 1; x + 1 < tile.width; ++x) {
            const auto texel = static_cast<std::size_t>(y * tile.width + x);
            const double height = above[texel];
            if (!(std::abs(height) > limit)) continue;
            const Neighbors neighbors = neighbors_at(before, x, y);
            const double value = before.values[texel];
            const Neighbors above_neighbors = neighbors_at(heights_above, x, y);
            const auto similar =
                std::count_if(neighbors.begin(), neighbors.end(), [&](double neighbor) {
                    return std::abs(neighbor - value) < max_similar_share * std::abs(height);
                });
            const auto rough =
                std::count_if(above_neighbors.begin(), above_neighbors.end(), [&](double neighbor) {
                    return std::abs(neighbor) > max_similar_share * std::abs(height);
                });
            if (similar > 1 || rough > 1) continue;
            tile.values[texel] -= height;
            heights.push_back(height);
        }
    }
    return heights;
}

/// Estimates the standard deviation of white noise with the high-pass mask (1 -2 1)^`times`.
double noise_deviation(std::span<const HeightTile> tiles, int times) {
    std::vector<double> all;
    for (const HeightTile& tile : tiles) {
        const std::vector<double> high = high_pass(tile, times);
        all.insert(all.end(), high.begin(), high.end());
    }
    return deviation_from_quantile(all);
}

}  // namespace

std::vector<double> high_pass(const HeightTile& tile, int times) {
    static constexpr std::array second_difference = {-2.0, 1.0};
    HeightTile high = tile;
    for (int i = 0; i < times; ++i)
        high = filtered(high, second_difference);
    // The squares of the binomial coefficients of 2 n add up to C(4 n, 2 n).
    const double gain = times == 2 ? 70.0 : 924.0;
    // At the border the mask reads the extension of the tile, which contains no noise.
    std::vector<double> inside;
    for (int y = times; y < tile.height - times; ++y) {
        for (int x = times; x < tile.width - times; ++x)
            inside.push_back(std::abs(high.values[static_cast<std::size_t>(y * tile.width + x)]) /
                             gain);
    }
    return inside;
}

double deviation_from_quantile(std::vector<double>& magnitudes) {
    if (magnitudes.empty()) return 0.0;
    // 20% of a Gaussian lies within 0.2533 standard deviations.
    const auto fifth = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 5);
    std::nth_element(magnitudes.begin(), fifth, magnitudes.end());
    return *fifth / 0.2533;
}

HeightTile filtered(const HeightTile& tile, std::span<const double> weights, int spacing) {
    HeightTile result = tile;
    filter_rows(result, weights, spacing);
    filter_columns(result, weights, spacing);
    return result;
}

TileSlopes reference_slopes(const HeightTile& tile, double min_edge, bool has_exact_levels) {
    // Between exact levels, every difference is a step edge, however close the next one is.
    const double times = has_exact_levels ? 0.0 : 4.0;
    TileSlopes result;
    result.slopes.resize(tile.values.size());
    std::vector<unsigned char>& beside = result.beside_edge;
    beside.resize(tile.values.size(), 0);
    for (const bool rows : {true, false}) {
        for_lines(tile, rows,
                  [&](std::size_t first, std::ptrdiff_t stride, int count, Wrap wrap,
                      std::vector<double>& padded) {
                      constexpr int margin = max_radius + 6;
                      read_line(tile.values.data() + first, stride, count, wrap, margin, padded);
                      const double* const line = padded.data() + margin;
                      std::vector<unsigned char> edges(padded.size(), 0);
                      for (int i = -max_radius; i < count + max_radius; ++i)
                          edges[static_cast<std::size_t>(i + margin)] =
                              is_step_edge(line + i, min_edge, times) ? 1 : 0;
                      for (int i = 0; i < count; ++i) {
                          int left = 0;
                          int right = 0;
                          const auto is_edge = [&](int at) {
                              return edges[static_cast<std::size_t>(at + margin)] != 0;
                          };
                          while (right < max_radius && !is_edge(i + right))
                              ++right;
                          while (left < max_radius && !is_edge(i - 1 - left))
                              ++left;
                          const auto texel = first + static_cast<std::size_t>(i * stride);
                          result.slopes[texel][rows ? 0 : 1] = slope_at(line + i, left, right);
                          if (std::min(left, right) == 0) beside[texel] = 1;
                      }
                  });
    }
    return result;
}

double reference_slope_response(double frequency) {
    static const auto weights = central_weights();
    double slope = 0.0;
    for (std::size_t k = 1; k <= max_radius; ++k)
        slope += 2.0 * weights[max_radius][k] * portable::sin(static_cast<double>(k) * frequency);
    return slope;
}

std::vector<double> remove_outliers(HeightTile& tile, double min_height) {
    std::vector<double> heights;
    // One of two adjacent outliers hides the other, so one pass does not remove both.
    constexpr int passes = 3;
    for (int pass = 0; pass < passes; ++pass) {
        const std::vector<double> removed = remove_isolated_outliers(tile, min_height);
        if (removed.empty()) break;
        heights.insert(heights.end(), removed.begin(), removed.end());
    }
    return heights;
}

OctaveDeviations octave_deviations(std::span<const HeightTile> tiles) {
    // The low-pass mask (1 4 6 4 1) / 16, whose tap spacing doubles with each octave, and the
    // standard deviations of white noise of deviation 1 in these octave bands.
    static constexpr std::array binomial = {0.375, 0.25, 0.0625};
    static constexpr std::array gains = {0.890796, 0.200664, 0.0855075, 0.0412174};
    std::vector<HeightTile> low_pass(tiles.begin(), tiles.end());
    OctaveDeviations result{};
    for (std::size_t octave = 0; octave < gains.size(); ++octave) {
        std::vector<double> magnitudes;
        for (HeightTile& tile : low_pass) {
            HeightTile low = filtered(tile, binomial, 1 << octave);
            // At the border the mask reads the extension of the tile.
            const int margin = std::min(tile.width, tile.height) > 32 ? 3 << octave : 0;
            for (int y = margin; y < tile.height - margin; ++y) {
                for (int x = margin; x < tile.width - margin; ++x) {
                    const auto texel = static_cast<std::size_t>(y * tile.width + x);
                    magnitudes.push_back(std::abs(tile.values[texel] - low.values[texel]));
                }
            }
            tile = std::move(low);
        }
        result[octave] = deviation_from_quantile(magnitudes) / gains[octave];
    }
    return result;
}

HighPassNoise high_pass_noise(std::span<const HeightTile> tiles) {
    const double second_order = noise_deviation(tiles, 2);
    const double third_order = noise_deviation(tiles, 3);
    return {std::min(second_order, third_order), third_order <= 1.1 * second_order};
}

}  // namespace relief::detail
