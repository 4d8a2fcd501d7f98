// SPDX-License-Identifier: Apache-2.0
// Statistics of height maps. Heights in their own unit, 1.0 being white. Texels that are not finite
// are left out; a wrong image throws. Tests: tests/mesh/image/heights/height_statistics_test.cpp.
#include "relief/mesh/height_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "image/heights/seam_survey.h"
#include "image/largest_sample.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// The heights of a map by place, in double.
template <typename Sample>
class Heights {
  public:
    explicit Heights(const Image& image)
        : width(image.width), height(image.height), samples_(image.as<Sample>()) {}

    [[nodiscard]] double at(int column, int row) const {
        const auto texel = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(column);
        return static_cast<double>(samples_[texel]) / largest;
    }
    [[nodiscard]] std::span<const Sample> samples() const { return samples_; }

    static constexpr double largest = largest_sample<Sample>;
    int width, height;

  private:
    std::span<const Sample> samples_;
};

/// Calls with_heights(Heights) of the image's type.
template <typename WithHeights>
auto on_heights(const Image& image, const WithHeights& with_heights) {
    if (image.empty()) throw InvalidInput("an empty height field has no statistics");
    if (image.channels != 1)
        throw InvalidInput(fmt::format("a height field has one channel, not {}", image.channels));
    if (image.bits() == 8) return with_heights(Heights<std::uint8_t>(image));
    if (image.bits() == 16) return with_heights(Heights<std::uint16_t>(image));
    return with_heights(Heights<float>(image));
}

template <typename Sample>
HeightDepth depth_of(const Heights<Sample>& heights) {
    const auto [least, greatest] =
        std::minmax_element(heights.samples().begin(), heights.samples().end());
    if (*least == *greatest) return {1, *least == 0 ? 1.0 : *least / heights.largest};
    unsigned divisor = 0;
    for (const Sample sample : heights.samples()) {
        divisor = std::gcd(divisor, static_cast<unsigned>(sample - *least));
        if (divisor == 1) break;
    }
    const auto levels = static_cast<unsigned>(heights.largest) / divisor;
    return {static_cast<int>(std::bit_width(levels)), divisor / heights.largest};
}

/// Whether all heights are multiples of a step, to within float's rounding.
bool are_multiples(std::span<const float> heights, double step) {
    return std::all_of(heights.begin(), heights.end(), [step](float height) {
        if (!std::isfinite(height)) return true;
        const double times = static_cast<double>(height) / step;
        return std::abs(times - std::round(times)) <= 1.2e-7 * std::abs(times);
    });
}

HeightDepth depth_of(const Heights<float>& heights) {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    for (const float sample : heights.samples()) {
        if (!std::isfinite(sample)) continue;
        least = std::min(least, static_cast<double>(sample));
        greatest = std::max(greatest, static_cast<double>(sample));
    }
    if (!(least < greatest))
        return {1, std::isfinite(least) && least != 0.0 ? std::abs(least) : 1.0};
    // Floats beyond 2^24 steps are multiples of them whatever they stand for.
    constexpr double most_steps = 0x1p24;
    const double largest = std::max(std::abs(least), std::abs(greatest));
    const auto are_on_levels = [&](double levels) {
        return largest * levels <= most_steps && are_multiples(heights.samples(), 1.0 / levels);
    };
    for (int bits = 1; bits <= 16; ++bits) {
        for (const double levels : {std::exp2(bits) - 1.0, std::exp2(bits)}) {
            if (are_on_levels(levels)) return {bits, 1.0 / levels};
        }
    }
    // The mean of three colours of 8 bits.
    constexpr double mean_levels = 3 * 255;
    if (are_on_levels(mean_levels)) return {10, 1.0 / mean_levels};
    return {};
}

/// The sum of the mask's absolute values in one row, and how many are finite.
struct RowOfNoise {
    double sum = 0.0;
    std::size_t count = 0;
};

template <typename Sample>
double noise_of(const Heights<Sample>& heights) {
    if (heights.width < 3 || heights.height < 3) return 0.0;
    std::vector<RowOfNoise> rows(static_cast<std::size_t>(heights.height - 2));
    parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int row = static_cast<int>(i) + 1;
            // 1 -2 1 along the row of what 1 -2 1 makes of each column.
            const auto bend = [&](int column) {
                return heights.at(column, row - 1) - 2.0 * heights.at(column, row) +
                       heights.at(column, row + 1);
            };
            for (int column = 1; column + 1 < heights.width; ++column) {
                const double value =
                    std::abs(bend(column - 1) - 2.0 * bend(column) + bend(column + 1));
                if (!std::isfinite(value)) continue;
                rows[i].sum += value;
                ++rows[i].count;
            }
        }
    });
    RowOfNoise all;
    for (const RowOfNoise& row : rows) {
        all.sum += row.sum;
        all.count += row.count;
    }
    // The mask's squares add up to 36; the mean of |x| of a Gaussian is sqrt(2 / pi) deviations.
    if (all.count == 0) return 0.0;
    return std::sqrt(std::numbers::pi / 2.0) * all.sum / (6.0 * static_cast<double>(all.count));
}

}  // namespace

Tiling detect_tiling(const Image& height) {
    return on_heights(height, [](const auto& heights) {
        SeamSurvey survey(heights.width, heights.height);
        const auto width = static_cast<std::size_t>(heights.width);
        for (int row = 0; row < heights.height; ++row)
            survey.add_row(heights.samples().subspan(static_cast<std::size_t>(row) * width, width));
        return survey.tiling();
    });
}

HeightDepth height_depth(const Image& height) {
    return on_heights(height, [](const auto& heights) { return depth_of(heights); });
}

double height_noise(const Image& height) {
    return on_heights(height, [](const auto& heights) { return noise_of(heights); });
}

}  // namespace relief
