// SPDX-License-Identifier: Apache-2.0
// Filters over small height fields in double, for the choice of a kernel: slopes of high order that
// stop at cliffs (essentially non-oscillatory, after [Harten et al. 1987]), and noise by what is
// left of a field in its highest frequencies, after [Immerkaer 1996]. Nothing throws.
// Tests: tests/mesh/accuracy/kernel_choice_test.cpp.
#include "accuracy/height_tile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/portable_math.h"
#include "image/texel_loops.h"
#include "parallel.h"

namespace relief {
namespace {

double beyond(const double* line, std::ptrdiff_t stride, int place, int count, Wrap wrap) {
    if (wrap != Wrap::clamp) return line[place_within(place, count, wrap) * stride];
    return reflected(place, count, [&](int at) { return line[at * stride]; });
}

/// A line of a tile with what lies beyond both ends: element `margin` is the first.
void read_line(const double* line, std::ptrdiff_t stride, int count, Wrap wrap, int margin,
               std::vector<double>& padded) {
    padded.resize(static_cast<std::size_t>(count + 2 * margin));
    for (int i = -margin; i < count + margin; ++i)
        padded[static_cast<std::size_t>(i + margin)] = beyond(line, stride, i, count, wrap);
}

/// Calls with_line(first index, stride, count, wrap) for all rows, then for all columns.
template <typename WithLine>
void for_lines(const HeightTile& tile, bool rows, const WithLine& with_line) {
    const int lines = rows ? tile.height : tile.width;
    parallel_for(static_cast<std::size_t>(lines), 16, [&](std::size_t begin, std::size_t end) {
        std::vector<double> padded;
        for (std::size_t line = begin; line < end; ++line) {
            const std::size_t first = rows ? line * static_cast<std::size_t>(tile.width) : line;
            with_line(first, rows ? 1 : tile.width, rows ? tile.width : tile.height,
                      rows ? tile.wrap.x : tile.wrap.y, padded);
        }
    });
}

void filter_lines(HeightTile& tile, std::span<const double> weights, int spacing, bool rows) {
    const int reach = static_cast<int>(weights.size() - 1) * spacing;
    for_lines(tile, rows,
              [&](std::size_t first, std::ptrdiff_t stride, int count, Wrap wrap,
                  std::vector<double>& padded) {
                  double* const line = tile.values.data() + first;
                  read_line(line, stride, count, wrap, reach, padded);
                  const double* const middle = padded.data() + reach;
                  for (int i = 0; i < count; ++i) {
                      double sum = weights[0] * middle[i];
                      for (std::size_t k = 1; k < weights.size(); ++k) {
                          const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(k) * spacing;
                          sum += weights[k] * (middle[i - offset] + middle[i + offset]);
                      }
                      line[i * stride] = sum;
                  }
              });
}

constexpr int widest_difference = 6;  ///< Half the order of the slopes.

/// Weights of h[k] - h[-k] for a central difference of order 2 m.
std::array<std::array<double, widest_difference + 1>, widest_difference + 1> central_weights() {
    std::array<std::array<double, widest_difference + 1>, widest_difference + 1> weights{};
    for (int m = 1; m <= widest_difference; ++m) {
        double ratio = 1.0;  // (m!)^2 / ((m-k)! (m+k)!)
        for (int k = 1; k <= m; ++k) {
            ratio *= static_cast<double>(m - k + 1) / (m + k);
            weights[static_cast<std::size_t>(m)][static_cast<std::size_t>(k)] =
                (k % 2 == 1 ? 1.0 : -1.0) * ratio / k;
        }
    }
    return weights;
}

/// A jump that towers over all changes near it, but for those right beside it.
bool is_cliff(const double* line, double least, double times) {
    constexpr int near = 4;
    const double jump = std::abs(line[1] - line[0]);
    if (jump < least || jump == 0.0) return false;
    double greatest = 0.0;
    for (int k = 1; k <= near; ++k) {
        greatest =
            std::max({greatest, std::abs(line[k + 1] - line[k]), std::abs(line[1 - k] - line[-k])});
    }
    return jump > times * greatest;
}

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

/// The high frequencies of a tile by the mask (1 -2 1), `times` times over both axes, for noise of
/// deviation 1 of deviation 1.
std::vector<double> masked(const HeightTile& tile, int times) {
    static constexpr std::array bend = {-2.0, 1.0};
    HeightTile high = tile;
    for (int i = 0; i < times; ++i)
        high = filtered(high, bend);
    // Squares of binomial coefficients of 2 n add up to C(4 n, 2 n).
    const double gain = times == 2 ? 70.0 : 924.0;
    // At the border the mask has only what goes on beyond it, which is no noise.
    std::vector<double> inside;
    for (int y = times; y < tile.height - times; ++y) {
        for (int x = times; x < tile.width - times; ++x)
            inside.push_back(std::abs(high.values[static_cast<std::size_t>(y * tile.width + x)]) /
                             gain);
    }
    return inside;
}

using Neighbors = std::array<double, 8>;

/// The texels around one that is not at the border, opposite ones 4 apart.
Neighbors neighbors_of(const HeightTile& tile, int x, int y) {
    constexpr int around[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                  {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    Neighbors result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
        const int at = (y + around[i][1]) * tile.width + x + around[i][0];
        result[i] = tile.values[static_cast<std::size_t>(at)];
    }
    return result;
}

/// How far a texel is above the lines between opposite neighbors: the median of the four.
double height_above(const Neighbors& around, double value) {
    std::array<double, 4> above{};
    for (std::size_t i = 0; i < 4; ++i)
        above[i] = value - 0.5 * (around[i] + around[i + 4]);
    std::sort(above.begin(), above.end());
    return 0.5 * (above[1] + above[2]);
}

std::vector<double> remove_lone_spikes(HeightTile& tile, double least) {
    // No Gaussian noise and no detail that a kernel could resolve sticks out as far.
    constexpr double deviations = 8.0;
    // Corners and ends of lines have neighbors that are much like them; along an edge, neighbors
    // stick out as well.
    constexpr double alike = 0.4;
    HeightTile sticking_out{tile.width, tile.height, tile.wrap,
                            std::vector<double>(tile.values.size(), 0.0)};
    std::vector<double>& above = sticking_out.values;
    std::vector<double> sizes;
    for (int y = 1; y + 1 < tile.height; ++y) {
        for (int x = 1; x + 1 < tile.width; ++x) {
            const auto texel = static_cast<std::size_t>(y * tile.width + x);
            above[texel] = height_above(neighbors_of(tile, x, y), tile.values[texel]);
            sizes.push_back(std::abs(above[texel]));
        }
    }
    if (sizes.empty()) return {};
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    // The median of the size of a Gaussian is 0.6745 deviations.
    const double limit = std::max(least, deviations * *middle / 0.6745);
    const HeightTile before = tile;
    std::vector<double> heights;
    for (int y = 1; y + 1 < tile.height; ++y) {
        for (int x = 1; x + 1 < tile.width; ++x) {
            const auto texel = static_cast<std::size_t>(y * tile.width + x);
            const double height = above[texel];
            if (!(std::abs(height) > limit)) continue;
            const Neighbors around = neighbors_of(before, x, y);
            const double value = before.values[texel];
            const Neighbors above_around = neighbors_of(sticking_out, x, y);
            const auto like = std::count_if(around.begin(), around.end(), [&](double neighbor) {
                return std::abs(neighbor - value) < alike * std::abs(height);
            });
            const auto rough = std::count_if(
                above_around.begin(), above_around.end(),
                [&](double neighbor) { return std::abs(neighbor) > alike * std::abs(height); });
            if (like > 1 || rough > 1) continue;
            tile.values[texel] -= height;
            heights.push_back(height);
        }
    }
    return heights;
}

/// Deviation of Gaussian values, of which only the smallest fifth must be without detail.
double deviation_of_quietest(std::vector<double>& sizes) {
    if (sizes.empty()) return 0.0;
    // A fifth of a Gaussian lies within 0.2533 deviations.
    const auto fifth = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 5);
    std::nth_element(sizes.begin(), fifth, sizes.end());
    return *fifth / 0.2533;
}

double noise_by(std::span<const HeightTile> tiles, int times) {
    std::vector<double> all;
    for (const HeightTile& tile : tiles) {
        const std::vector<double> high = masked(tile, times);
        all.insert(all.end(), high.begin(), high.end());
    }
    return deviation_of_quietest(all);
}

}  // namespace

HeightTile filtered(const HeightTile& tile, std::span<const double> weights, int spacing) {
    HeightTile result = tile;
    filter_lines(result, weights, spacing, true);
    filter_lines(result, weights, spacing, false);
    return result;
}

TileSlopes true_slopes(const HeightTile& tile, double min_cliff, bool has_exact_levels) {
    // Between exact levels, every change is a cliff, however close the next one is.
    const double times = has_exact_levels ? 0.0 : 4.0;
    TileSlopes result;
    result.slopes.resize(tile.values.size());
    std::vector<unsigned char>& beside = result.beside_cliff;
    beside.resize(tile.values.size(), 0);
    for (const bool rows : {true, false}) {
        for_lines(tile, rows,
                  [&](std::size_t first, std::ptrdiff_t stride, int count, Wrap wrap,
                      std::vector<double>& padded) {
                      constexpr int margin = widest_difference + 6;
                      read_line(tile.values.data() + first, stride, count, wrap, margin, padded);
                      const double* const line = padded.data() + margin;
                      std::vector<unsigned char> cliffs(padded.size(), 0);
                      for (int i = -widest_difference; i < count + widest_difference; ++i)
                          cliffs[static_cast<std::size_t>(i + margin)] =
                              is_cliff(line + i, min_cliff, times) ? 1 : 0;
                      for (int i = 0; i < count; ++i) {
                          int left = 0;
                          int right = 0;
                          const auto cliff = [&](int at) {
                              return cliffs[static_cast<std::size_t>(at + margin)] != 0;
                          };
                          while (right < widest_difference && !cliff(i + right))
                              ++right;
                          while (left < widest_difference && !cliff(i - 1 - left))
                              ++left;
                          const auto texel = first + static_cast<std::size_t>(i * stride);
                          result.slopes[texel][rows ? 0 : 1] = slope_at(line + i, left, right);
                          if (std::min(left, right) == 0) beside[texel] = 1;
                      }
                  });
    }
    return result;
}

double true_slope_response(double frequency) {
    static const auto weights = central_weights();
    double slope = 0.0;
    for (std::size_t k = 1; k <= widest_difference; ++k)
        slope +=
            2.0 * weights[widest_difference][k] * portable::sin(static_cast<double>(k) * frequency);
    return slope;
}

std::vector<double> remove_spikes(HeightTile& tile, double least) {
    std::vector<double> heights;
    // Where two are side by side, one hides the other.
    constexpr int passes = 3;
    for (int pass = 0; pass < passes; ++pass) {
        const std::vector<double> found = remove_lone_spikes(tile, least);
        if (found.empty()) break;
        heights.insert(heights.end(), found.begin(), found.end());
    }
    return heights;
}

QuietDeviations quiet_deviations(std::span<const HeightTile> tiles) {
    // The mask (1 4 6 4 1) / 16, its taps twice as far apart in each octave, and the deviation that
    // its octaves leave of white noise of deviation 1.
    static constexpr std::array binomial = {0.375, 0.25, 0.0625};
    static constexpr std::array gains = {0.890796, 0.200664, 0.0855075, 0.0412174};
    std::vector<HeightTile> rest(tiles.begin(), tiles.end());
    QuietDeviations result{};
    for (std::size_t octave = 0; octave < gains.size(); ++octave) {
        std::vector<double> sizes;
        for (HeightTile& tile : rest) {
            HeightTile low = filtered(tile, binomial, 1 << octave);
            // At the border the mask has what goes on beyond it.
            const int margin = std::min(tile.width, tile.height) > 32 ? 3 << octave : 0;
            for (int y = margin; y < tile.height - margin; ++y) {
                for (int x = margin; x < tile.width - margin; ++x) {
                    const auto texel = static_cast<std::size_t>(y * tile.width + x);
                    sizes.push_back(std::abs(tile.values[texel] - low.values[texel]));
                }
            }
            tile = std::move(low);
        }
        result[octave] = deviation_of_quietest(sizes) / gains[octave];
    }
    return result;
}

HighFrequencies high_frequencies(std::span<const HeightTile> tiles) {
    const double wide = noise_by(tiles, 2);
    const double narrow = noise_by(tiles, 3);
    return {std::min(wide, narrow), narrow <= 1.1 * wide};
}

}  // namespace relief
