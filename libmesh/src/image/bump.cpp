// SPDX-License-Identifier: Apache-2.0
// Normals of a height field by finite differences [Blinn 1978], kernels after [Sobel and Feldman
// 1968] scaled to unit gain. Tangent space: x right, y up in the image, z out; heights times
// strength are in texels, and so slopes are plain numbers. All sums in double, rounded once.
// Non-finite heights are filled first (height_field.cpp) and counted; a bad image or strength
// throws. Tests: tests/mesh/image/bump_test.cpp.
#include "relief/mesh/bump.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/height_field.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::size_t texels_per_piece = 1 << 14;
// Differences of floats reach 7e38; with this, slopes and their squares stay in double's range.
constexpr double largest_strength = 1e30;

/// The two neighbours of a place along one axis, and how many steps lie between them.
struct Neighbours {
    int before = 0;
    int after = 0;
    double inverse_distance = 0.5;
};

Neighbours neighbours_of(int place, int count, Wrap wrap) {
    if (wrap == Wrap::repeat)
        return {place == 0 ? count - 1 : place - 1, place == count - 1 ? 0 : place + 1, 0.5};
    const int before = std::max(place - 1, 0);
    const int after = std::min(place + 1, count - 1);
    // At the border the difference is one-sided, over one step; a single texel has no slope.
    return {before, after, after - before == 2 ? 0.5 : 1.0};
}

/// The three rows that the kernels read, and the row's own scale across them.
struct Rows {
    const float* above;
    const float* here;
    const float* below;
    double inverse_distance;
};

struct Slope {
    double right;
    double up;
};

/// Half the difference of the two neighbours.
struct Central3 {
    static Slope slope(const Rows& rows, int left, int column, int right) {
        const auto c = static_cast<std::size_t>(column);
        return {static_cast<double>(rows.here[right]) - static_cast<double>(rows.here[left]),
                static_cast<double>(rows.above[c]) - static_cast<double>(rows.below[c])};
    }
};

/// Differences of three lines, weighted 1 2 1 and divided by 4. The outer two are added first, so
/// that a mirrored map gives mirrored bits.
struct Sobel3 {
    static Slope slope(const Rows& rows, int left, int column, int right) {
        const auto across = [&](const float* row) {
            return static_cast<double>(row[right]) - static_cast<double>(row[left]);
        };
        const auto along = [&](int at) {
            return static_cast<double>(rows.above[at]) - static_cast<double>(rows.below[at]);
        };
        return {((across(rows.above) + across(rows.below)) + 2.0 * across(rows.here)) * 0.25,
                ((along(left) + along(right)) + 2.0 * along(column)) * 0.25};
    }
};

/// normalize(-slope, 1); adding zero turns -0 into 0, so that flat is (0,0,1) to the bit.
void store_normal(float* normal, double right, double up) {
    const double scale = 1.0 / std::sqrt(right * right + up * up + 1.0);
    normal[0] = static_cast<float>(0.0 - right * scale);
    normal[1] = static_cast<float>(0.0 - up * scale);
    normal[2] = static_cast<float>(scale);
}

template <typename Difference>
void row_of_normals(const Rows& rows, int width, const BumpOptions& options, float* normals) {
    const double up_scale = rows.inverse_distance * options.strength;
    const auto texel = [&](int left, int column, int right, double right_scale) {
        const Slope slope = Difference::slope(rows, left, column, right);
        store_normal(normals + static_cast<std::ptrdiff_t>(column) * 3, slope.right * right_scale,
                     slope.up * up_scale);
    };
    const auto border = [&](int column) {
        const Neighbours beside = neighbours_of(column, width, options.wrap);
        texel(beside.before, column, beside.after, beside.inverse_distance * options.strength);
    };
    border(0);
    const double right_scale = 0.5 * options.strength;
    for (int column = 1; column < width - 1; ++column)
        texel(column - 1, column, column + 1, right_scale);
    if (width > 1) border(width - 1);
}

template <typename Difference>
void all_normals(const float* heights, const BumpOptions& options, Image& result) {
    const int width = result.width;
    const int height = result.height;
    float* normals = result.as<float>().data();
    const std::size_t rows_per_piece =
        std::max<std::size_t>(1, texels_per_piece / static_cast<std::size_t>(width));
    const auto rows = static_cast<std::size_t>(height);
    parallel_for(rows, rows_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const Neighbours beside = neighbours_of(static_cast<int>(row), height, options.wrap);
            const auto line = [&](std::size_t r) {
                return heights + r * static_cast<std::size_t>(width);
            };
            const Rows three{line(static_cast<std::size_t>(beside.before)), line(row),
                             line(static_cast<std::size_t>(beside.after)), beside.inverse_distance};
            row_of_normals<Difference>(three, width, options,
                                       normals + row * static_cast<std::size_t>(width) * 3);
        }
    });
}

void check(const Image& height, const BumpOptions& options) {
    if (height.empty()) throw InvalidInput("an empty height field has no normals");
    if (height.channels != 1 || height.bits() != 32) {
        throw InvalidInput(fmt::format("a height field has one float channel, not {} of {} bits",
                                       height.channels, height.bits()));
    }
    if (!(std::abs(options.strength) <= largest_strength)) {
        throw InvalidInput(
            fmt::format("the strength {} is not within +-{}", options.strength, largest_strength));
    }
}

}  // namespace

Image normals_from_height(const Image& height, const BumpOptions& options, Report& report) {
    check(height, options);
    Image result = make_image(height.width, height.height, 3, 32, ColorSpace::data);
    const std::vector<float> whole = filled_holes(height, options.wrap, report);
    const float* heights = whole.empty() ? height.as<float>().data() : whole.data();
    switch (options.kernel) {
        case Kernel::central3:
            all_normals<Central3>(heights, options, result);
            break;
        case Kernel::sobel3:
            all_normals<Sobel3>(heights, options, result);
            break;
    }
    return result;
}

}  // namespace relief
