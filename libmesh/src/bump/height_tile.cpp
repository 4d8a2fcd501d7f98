// SPDX-License-Identifier: Apache-2.0
// Filters and noise estimators for small height fields: derivatives of high order that do not cross
// step edges (essentially non-oscillatory, after [Harten et al. 1987]), the removal of outliers,
// and noise estimates by high-pass masks, after [Immerkaer 1996]. Nothing throws.
// Tests: tests/mesh/bump/kernel_choice_test.cpp.
#include "bump/height_tile.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "bump/tile_loops.h"
#include "image/texel_loops.h"
#include "portable_math.h"

namespace relief::detail {
namespace {

/// Returns a sample of a line, also beyond its ends.
double sample_at(const double* line, std::ptrdiff_t stride, int index, int count, Wrap wrap) {
    if (wrap != Wrap::clamp) return line[place_within(index, count, wrap) * stride];
    return reflected(index, count, [&](int at) { return line[at * stride]; });
}

/// Copies a row of a tile and extends it beyond both ends. Element `margin` of the result is the
/// first element of the row.
void read_row(const double* row, int count, Wrap wrap, int margin, std::vector<double>& padded) {
    padded.resize(static_cast<std::size_t>(count + 2 * margin));
    double* const line = padded.data() + margin;
    std::copy_n(row, count, line);
    double* const last = line + count - 1;
    for (int i = 1; i <= margin; ++i) {
        if (wrap == Wrap::clamp && count > 1) {
            // reflected(), whose reflections of elements beyond the other end are known already.
            line[-i] = 2 * line[0] - line[i];
            last[i] = 2 * last[0] - last[-i];
        } else {
            line[-i] = sample_at(row, 1, -i, count, wrap);
            last[i] = sample_at(row, 1, count - 1 + i, count, wrap);
        }
    }
}

/// Fills a row beyond the border of a tile from the rows inside, which are contiguous.
void extend_row(const double* rows, int row, int height, int width, Wrap wrap, double* to) {
    const int edge = row < 0 ? 0 : height - 1;
    const int inner = 2 * edge - row;
    if (wrap == Wrap::clamp && inner >= 0 && inner < height) {
        const double* const border = rows + static_cast<std::ptrdiff_t>(edge) * width;
        const double* const inside = rows + static_cast<std::ptrdiff_t>(inner) * width;
        for (int x = 0; x < width; ++x)
            to[x] = 2 * border[x] - inside[x];
        return;
    }
    for (int x = 0; x < width; ++x)
        to[x] = sample_at(rows + x, width, row, height, wrap);
}

constexpr int max_radius = max_slope_radius;

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
    const VectorTarget target = best_vector_target();
    std::vector<double> magnitudes;
    for (int y = 1; y + 1 < tile.height && tile.width > 2; ++y) {
        const auto first = static_cast<std::size_t>(y * tile.width + 1);
        const auto count = static_cast<std::size_t>(tile.width - 2);
        const double* const here = tile.values.data() + first;
        heights_above_neighbors(target, here - tile.width, here, here + tile.width, count,
                                above.data() + first);
        for (std::size_t i = first; i < first + count; ++i)
            magnitudes.push_back(std::abs(above[i]));
    }
    if (magnitudes.empty()) return {};
    const double median = smallest_of(magnitudes, magnitudes.size() / 2);
    // The median absolute value of a Gaussian is 0.6745 standard deviations.
    const double limit = std::max(min_height, max_deviations * median / 0.6745);
    if (std::none_of(above.begin(), above.end(),
                     [limit](double height) { return std::abs(height) > limit; }))
        return {};
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

/// Applies the high-pass mask (1 -2 1) once along both axes. The result is smaller by a texel along
/// the border.
HeightTile second_differences(const HeightTile& tile) {
    HeightTile result{std::max(0, tile.width - 2), std::max(0, tile.height - 2), tile.wrap, {}};
    if (result.width == 0 || result.height == 0) return {};
    const VectorTarget target = best_vector_target();
    const auto width = static_cast<std::size_t>(result.width);
    const auto height = static_cast<std::size_t>(result.height);
    std::vector<double> along_rows(width * (height + 2));
    for (std::size_t y = 0; y < height + 2; ++y)
        second_difference(target, tile.values.data() + y * (width + 2), 1, width,
                          along_rows.data() + y * width);
    result.values.resize(width * height);
    second_difference(target, along_rows.data(), result.width, width * height,
                      result.values.data());
    return result;
}

/// Appends the absolute values, divided by the gain for white noise.
void append_magnitudes(const HeightTile& differences, int times, std::vector<double>& magnitudes) {
    // The squares of the binomial coefficients of 2 n add up to C(4 n, 2 n).
    const double gain = times == 2 ? 70.0 : 924.0;
    for (const double value : differences.values)
        magnitudes.push_back(std::abs(value) / gain);
}

}  // namespace

std::vector<double> high_pass(const HeightTile& tile, int times) {
    HeightTile high = tile;
    for (int i = 0; i < times; ++i)
        high = second_differences(high);
    std::vector<double> magnitudes;
    append_magnitudes(high, times, magnitudes);
    return magnitudes;
}

double smallest_of(std::span<const double> magnitudes, std::size_t rank) {
    // Numbers are compared in several lanes, which need not wait for each other.
    constexpr std::size_t lanes = 8;
    std::array<double, lanes> greatest{};
    for (std::size_t i = 0; i + lanes <= magnitudes.size(); i += lanes) {
        for (std::size_t lane = 0; lane < lanes; ++lane)
            greatest[lane] = std::max(greatest[lane], magnitudes[i + lane]);
    }
    for (std::size_t i = magnitudes.size() / lanes * lanes; i < magnitudes.size(); ++i)
        greatest[0] = std::max(greatest[0], magnitudes[i]);
    // Classes of 1/16 octave below the largest number. Only that of the result is sorted.
    constexpr int shift = 48;
    constexpr std::uint64_t classes = 1024;
    const auto class_of = [](double value) { return std::bit_cast<std::uint64_t>(value) >> shift; };
    const std::uint64_t top = class_of(*std::max_element(greatest.begin(), greatest.end()));
    std::array<std::uint32_t, classes> counts{};
    const auto place_of = [&](double value) {
        return std::min<std::uint64_t>(top - class_of(value), classes - 1);
    };
    for (const double value : magnitudes)
        ++counts[place_of(value)];
    std::size_t below = magnitudes.size();
    std::size_t place = 0;
    while (below - counts[place] > rank)
        below -= counts[place++];
    below -= counts[place];
    std::vector<double> near;
    near.reserve(counts[place]);
    for (const double value : magnitudes) {
        if (place_of(value) == place) near.push_back(value);
    }
    const auto result = near.begin() + static_cast<std::ptrdiff_t>(rank - below);
    std::nth_element(near.begin(), result, near.end());
    return *result;
}

double deviation_from_quantile(std::span<const double> magnitudes) {
    if (magnitudes.empty()) return 0.0;
    // 20% of a Gaussian lies within 0.2533 standard deviations.
    return smallest_of(magnitudes, magnitudes.size() / 5) / 0.2533;
}

HeightTile filtered(const HeightTile& tile, std::span<const double> weights, int spacing) {
    const VectorTarget target = best_vector_target();
    const int margin = static_cast<int>(weights.size() - 1) * spacing;
    const auto width = static_cast<std::size_t>(tile.width);
    // The filtered rows, with rows beyond the border on both sides.
    std::vector<double> padded(static_cast<std::size_t>(tile.height + 2 * margin) * width);
    double* const rows = padded.data() + static_cast<std::size_t>(margin) * width;
    std::vector<double> line;
    for (int y = 0; y < tile.height; ++y) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        read_row(tile.values.data() + first, tile.width, tile.wrap.x, margin, line);
        symmetric_filter(target, line.data() + margin, weights, spacing, width, rows + first);
    }
    for (int i = 1; i <= margin; ++i) {
        double* const above = rows - static_cast<std::ptrdiff_t>(i) * tile.width;
        extend_row(rows, -i, tile.height, tile.width, tile.wrap.y, above);
        double* const below = rows + static_cast<std::ptrdiff_t>(tile.height - 1 + i) * tile.width;
        extend_row(rows, tile.height - 1 + i, tile.height, tile.width, tile.wrap.y, below);
    }
    HeightTile result{tile.width, tile.height, tile.wrap, std::vector<double>(tile.values.size())};
    symmetric_filter(target, rows, weights, static_cast<std::ptrdiff_t>(spacing) * tile.width,
                     result.values.size(), result.values.data());
    return result;
}

namespace {

/// Computes the slopes along the rows of heights.
///
/// \param beside  gets 1 beside a step edge
void slopes_of_rows(const HeightTile& tile, double min_edge, double times, double* slopes,
                    unsigned char* beside) {
    static const auto weights = central_weights();
    const VectorTarget target = best_vector_target();
    constexpr int margin = max_radius + 6;
    const auto width = static_cast<std::size_t>(tile.width);
    std::vector<double> padded;
    std::vector<std::int64_t> edges(width + 2 * max_radius);
    for (int y = 0; y < tile.height; ++y) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        read_row(tile.values.data() + first, tile.width, tile.wrap.x, margin, padded);
        const double* const line = padded.data() + margin;
        central_slopes(target, line, weights[max_radius].data(), width, slopes + first);
        if (!find_step_edges(target, line - max_radius, edges.size(), min_edge, times,
                             edges.data()))
            continue;
        const auto is_edge = [&](int at) {
            return edges[static_cast<std::size_t>(at + max_radius)] != 0;
        };
        for (int x = 0; x < tile.width; ++x) {
            int left = 0;
            int right = 0;
            while (right < max_radius && !is_edge(x + right))
                ++right;
            while (left < max_radius && !is_edge(x - 1 - left))
                ++left;
            const std::size_t texel = first + static_cast<std::size_t>(x);
            if (std::min(left, right) < max_radius) slopes[texel] = slope_at(line + x, left, right);
            if (std::min(left, right) == 0) beside[texel] = 1;
        }
    }
}

/// Exchanges rows and columns.
template <typename T>
std::vector<T> transposed(const std::vector<T>& values, int width, int height) {
    std::vector<T> result(values.size());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            result[static_cast<std::size_t>(x * height + y)] =
                values[static_cast<std::size_t>(y * width + x)];
    }
    return result;
}

}  // namespace

TileSlopes reference_slopes(const HeightTile& tile, double min_edge, bool has_exact_levels) {
    // Between exact levels, every difference is a step edge, however close the next one is.
    const double times = has_exact_levels ? 0.0 : 4.0;
    TileSlopes result;
    result.right.resize(tile.values.size());
    result.beside_edge.resize(tile.values.size(), 0);
    slopes_of_rows(tile, min_edge, times, result.right.data(), result.beside_edge.data());
    const HeightTile columns{tile.height,
                             tile.width,
                             {tile.wrap.y, tile.wrap.x},
                             transposed(tile.values, tile.width, tile.height)};
    std::vector<double> down(tile.values.size());
    std::vector<unsigned char> beside(tile.values.size(), 0);
    slopes_of_rows(columns, min_edge, times, down.data(), beside.data());
    result.down = transposed(down, tile.height, tile.width);
    beside = transposed(beside, tile.height, tile.width);
    for (std::size_t i = 0; i < beside.size(); ++i)
        result.beside_edge[i] |= beside[i];
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
    std::vector<double> second;
    std::vector<double> third;
    for (const HeightTile& tile : tiles) {
        const HeightTile twice = second_differences(second_differences(tile));
        append_magnitudes(twice, 2, second);
        append_magnitudes(second_differences(twice), 3, third);
    }
    const double second_order = deviation_from_quantile(second);
    const double third_order = deviation_from_quantile(third);
    return {std::min(second_order, third_order), third_order <= 1.1 * second_order};
}

}  // namespace relief::detail
