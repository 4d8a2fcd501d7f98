// SPDX-License-Identifier: Apache-2.0
// Statistics of height maps, and of their seams. Heights are relative to white = 1. Texels that are
// not finite are left out; an invalid image throws. Seams are compared with at most 256 pairs of
// adjacent lines inside, evenly distributed.
#include "relief/mesh/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include "image/seam_survey.h"
#include "image/texel_loops.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Access to the heights of a map by column and row, in double.
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

void check_heights(const ImageView& image) {
    if (image.empty()) throw InvalidInput("the height field is empty");
    if (image.channels != 1)
        throw InvalidInput(fmt::format("a height field has one channel, not {}", image.channels));
}

/// Calls with_heights(Heights) for the sample type of the image.
template <typename WithHeights>
auto on_heights(const Image& image, const WithHeights& with_heights) {
    check_heights(image);
    if (image.bits() == 8) return with_heights(Heights<std::uint8_t>(image));
    if (image.bits() == 16) return with_heights(Heights<std::uint16_t>(image));
    return with_heights(Heights<float>(image));
}

/// Detects levels that were rounded to the codes of the file, as the 32 levels of 5 bits in a file
/// of 8 bits are: 0, 8, 16, 25, ...
///
/// \param used  all codes that occur, in ascending order
/// \param divisor  of their differences, which counts as one code
/// \return the mean distance of adjacent levels in codes, 1 if there are no such levels
double level_spacing(const std::vector<unsigned>& used, unsigned divisor) {
    for (std::size_t i = 1; i < used.size(); ++i) {
        if (used[i] - used[i - 1] == divisor) return 1.0;
    }
    std::vector<double> codes;
    for (const unsigned code : used) {
        const unsigned place = (code - used.front()) / divisor;
        codes.push_back(place);
    }
    const double max_code = codes.back();
    // Masks and terraces have fewer levels.
    constexpr std::size_t min_levels = 8;
    if (codes.size() < min_levels) return 1.0;
    double min_gap = max_code;
    for (std::size_t i = 1; i < codes.size(); ++i)
        min_gap = std::min(min_gap, codes[i] - codes[i - 1]);
    // The rounded distance of adjacent levels varies by 1. Each level refines the mean.
    double spacing = min_gap + 0.5;
    std::vector<double> levels{0.0};
    for (std::size_t i = 1; i < codes.size(); ++i) {
        const double step = std::round((codes[i] - codes[i - 1]) / spacing);
        levels.push_back(levels.back() + std::max(1.0, step));
        spacing = codes[i] / levels.back();
    }
    // The line of least squares through codes and levels has the mean spacing.
    const auto count = static_cast<double>(codes.size());
    const double mean_code = std::accumulate(codes.begin(), codes.end(), 0.0) / count;
    const double mean_level = std::accumulate(levels.begin(), levels.end(), 0.0) / count;
    double products = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        products += (codes[i] - mean_code) * (levels[i] - mean_level);
        squares += (levels[i] - mean_level) * (levels[i] - mean_level);
    }
    spacing = products / squares;
    double min_offset = std::numeric_limits<double>::infinity();
    double max_offset = -min_offset;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        min_offset = std::min(min_offset, codes[i] - spacing * levels[i]);
        max_offset = std::max(max_offset, codes[i] - spacing * levels[i]);
    }
    // Rounding shifts a level by at most half a code. Copying the high bits of a value into its low
    // ones shifts it by slightly more.
    constexpr double max_spread = 1.5;
    const double by_chance = portable::pow(max_spread / spacing, count - 2.0);
    return max_offset - min_offset <= max_spread && by_chance < 1e-3 ? spacing : 1.0;
}

template <typename Sample>
HeightDepth depth_of(const Heights<Sample>& heights) {
    std::vector<unsigned char> is_used(std::size_t{std::numeric_limits<Sample>::max()} + 1, 0);
    for (const Sample sample : heights.samples())
        is_used[sample] = 1;
    std::vector<unsigned> used;
    for (std::size_t i = 0; i < is_used.size(); ++i) {
        if (is_used[i] != 0) used.push_back(static_cast<unsigned>(i));
    }
    const unsigned least = used.front();
    if (used.size() == 1) return {1, least == 0 ? 1.0 : least / heights.largest};
    unsigned divisor = 0;
    for (std::size_t i = 1; i < used.size() && divisor != 1; ++i)
        divisor = std::gcd(divisor, used[i] - used[i - 1]);
    const double spacing = level_spacing(used, divisor);
    // The mean of rounded distances has an error; the distance of codes is exact.
    const double slack = spacing > 1.0 ? 0.25 : 0.0;
    const auto levels = static_cast<unsigned>(heights.largest / (spacing * divisor) + slack);
    return {static_cast<int>(std::bit_width(levels)), spacing * divisor / heights.largest};
}

/// Returns the codes that occur, in ascending order. Empty if there are too many.
std::vector<unsigned> used_codes(std::span<const float> samples, double least, double greatest,
                                 double code) {
    const double max_code = (greatest - least) / code;
    constexpr double max_codes = 65536.0;
    std::vector<unsigned> codes;
    if (!(max_code < max_codes)) return codes;
    std::vector<unsigned char> is_used(static_cast<std::size_t>(max_code + 1.5), 0);
    for (const float sample : samples) {
        const double value = static_cast<double>(sample);
        if (std::isfinite(value))
            is_used[static_cast<std::size_t>((value - least) / code + 0.5)] = 1;
    }
    for (std::size_t i = 0; i < is_used.size(); ++i) {
        if (is_used[i] != 0) codes.push_back(static_cast<unsigned>(i));
    }
    return codes;
}

/// The least and the greatest finite sample; infinity and -infinity if there is none.
struct SampleRange {
    float least = std::numeric_limits<float>::infinity();
    float greatest = -std::numeric_limits<float>::infinity();
};

SampleRange range_of(std::span<const float> samples) {
    // Samples are compared in several lanes, which need not wait for each other.
    constexpr std::size_t lanes = 16;
    std::array<SampleRange, lanes> ranges{};
    const auto add = [](SampleRange& range, float sample) {
        const bool is_finite = std::abs(sample) <= std::numeric_limits<float>::max();
        range.least = is_finite && sample < range.least ? sample : range.least;
        range.greatest = is_finite && sample > range.greatest ? sample : range.greatest;
    };
    std::size_t i = 0;
    for (; i + lanes <= samples.size(); i += lanes) {
        for (std::size_t lane = 0; lane < lanes; ++lane)
            add(ranges[lane], samples[i + lane]);
    }
    for (; i < samples.size(); ++i)
        add(ranges[0], samples[i]);
    for (const SampleRange& range : ranges) {
        ranges[0].least = std::min(ranges[0].least, range.least);
        ranges[0].greatest = std::max(ranges[0].greatest, range.greatest);
    }
    return ranges[0];
}

/// Returns whether all heights are multiples of a step within the rounding of float.
bool are_multiples(std::span<const float> heights, double step) {
    return std::all_of(heights.begin(), heights.end(), [step](float height) {
        if (!std::isfinite(height)) return true;
        const double times = static_cast<double>(height) / step;
        return std::abs(times - std::round(times)) <= 1.2e-7 * std::abs(times);
    });
}

HeightDepth depth_of(const Heights<float>& heights) {
    const SampleRange range = range_of(heights.samples());
    const double least = range.least;
    const double greatest = range.greatest;
    if (!(least < greatest))
        return {1, std::isfinite(least) && least != 0.0 ? std::abs(least) : 1.0};
    // Every float beyond 2^24 steps is a multiple of the step, whatever its origin.
    constexpr double max_steps = 0x1p24;
    const double largest = std::max(std::abs(least), std::abs(greatest));
    const auto are_on_levels = [&](double levels) {
        return largest * levels <= max_steps && are_multiples(heights.samples(), 1.0 / levels);
    };
    for (int bits = 1; bits <= 16; ++bits) {
        for (const double levels : {std::ldexp(1.0, bits) - 1.0, std::ldexp(1.0, bits)}) {
            if (!are_on_levels(levels)) continue;
            const std::vector<unsigned> codes =
                used_codes(heights.samples(), least, greatest, 1.0 / levels);
            const double spacing = codes.empty() ? 1.0 : level_spacing(codes, 1);
            const auto coarse = static_cast<unsigned>(levels / spacing + 0.25);
            return {spacing > 1.0 ? static_cast<int>(std::bit_width(coarse)) : bits,
                    spacing / levels};
        }
    }
    // The mean of three colors of 8 bits has these levels.
    constexpr double mean_levels = 3 * 255;
    if (are_on_levels(mean_levels)) return {10, 1.0 / mean_levels};
    return {};
}

/// The sum of the mask's absolute values in one row, and the number of finite ones.
struct NoiseRow {
    double sum = 0.0;
    std::size_t count = 0;
};

template <typename Sample>
double noise_of(const Heights<Sample>& heights) {
    if (heights.width < 3 || heights.height < 3) return 0.0;
    std::vector<NoiseRow> rows(static_cast<std::size_t>(heights.height - 2));
    parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int row = static_cast<int>(i) + 1;
            // The mask applies (1 -2 1) to each column, and then along the row.
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
    NoiseRow all;
    for (const NoiseRow& row : rows) {
        all.sum += row.sum;
        all.count += row.count;
    }
    // The squares of the mask's weights add up to 36; the mean of |x| of a Gaussian is sqrt(2 / pi)
    // deviations.
    if (all.count == 0) return 0.0;
    return std::sqrt(std::numbers::pi / 2.0) * all.sum / (6.0 * static_cast<double>(all.count));
}

}  // namespace

Tiling detect_tiling(const ImageView& height) {
    check_heights(height);
    return with_sample_type(height, [&]<typename Sample>(Sample) {
        SeamSurvey survey(height.width, height.height);
        for (int row = 0; row < height.height; ++row)
            survey.add_row(
                std::span(height.row<Sample>(row), static_cast<std::size_t>(height.width)));
        return survey.tiling();
    });
}

HeightDepth height_depth(const Image& height) {
    return on_heights(height, [](const auto& heights) { return depth_of(heights); });
}

double height_noise(const Image& height) {
    return on_heights(height, [](const auto& heights) { return noise_of(heights); });
}

namespace {

/// Returns the first line of each pair among `count` lines, followed by the last line, whose
/// neighbor across the seam is line 0.
template <typename Index>
std::vector<Index> pairs_of(int count) {
    constexpr int max_pairs = 256;
    const int pairs = std::min(count - 1, max_pairs);
    std::vector<Index> first;
    for (int i = 0; i < pairs; ++i)
        first.push_back(static_cast<Index>(static_cast<std::int64_t>(i) * (count - 1) / pairs));
    first.push_back(static_cast<Index>(count - 1));
    return first;
}

}  // namespace

void SeamSurvey::Mean::add(double difference) {
    if (!std::isfinite(difference)) return;
    squares += difference * difference;
    ++count;
}

double SeamSurvey::Mean::root() const {
    return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

SeamSurvey::SeamSurvey(int width, int height)
    : height_(height),
      columns_(pairs_of<std::size_t>(width)),
      row_pairs_(pairs_of<int>(height)),
      across_columns_(columns_.size()) {}

SeamSurvey::Mean SeamSurvey::change_to(std::span<const double> next) const {
    Mean mean;
    for (std::size_t x = 0; x < next.size(); ++x)
        mean.add(next[x] - previous_[x]);
    return mean;
}

template <typename Sample>
void SeamSurvey::add_row(std::span<const Sample> row) {
    constexpr double largest = largest_sample<Sample>;
    const auto at = [&](std::size_t x) { return static_cast<double>(row[x]) / largest; };
    for (std::size_t i = 0; i < columns_.size(); ++i)
        across_columns_[i].add(at((columns_[i] + 1) % row.size()) - at(columns_[i]));

    // Only rows at which a pair begins or ends are needed, and row 0 for the seam.
    const std::size_t pair = across_rows_.size();
    const bool ends_pair = pair + 1 < row_pairs_.size() && row_pairs_[pair] == rows_ - 1;
    const std::size_t next = pair + (ends_pair ? 1 : 0);
    const bool begins_pair = row_pairs_[next] == rows_;
    if (ends_pair || begins_pair || rows_ == 0) {
        std::vector<double> heights(row.size());
        for (std::size_t x = 0; x < row.size(); ++x)
            heights[x] = at(x);
        if (ends_pair) across_rows_.push_back(change_to(heights));
        if (rows_ == 0) first_ = heights;
        previous_ = std::move(heights);
    }
    if (++rows_ == height_) across_rows_.push_back(change_to(first_));
}

template void SeamSurvey::add_row(std::span<const std::uint8_t>);
template void SeamSurvey::add_row(std::span<const std::uint16_t>);
template void SeamSurvey::add_row(std::span<const float>);

double SeamSurvey::seam_of(const std::vector<Mean>& lines) {
    const double seam = lines.back().root();
    if (seam == 0.0) return 0.0;
    double inside = 0.0;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i)
        inside = std::max(inside, lines[i].root());
    return inside > 0.0 ? seam / inside : std::numeric_limits<double>::infinity();
}

Tiling SeamSurvey::tiling() const {
    return {seam_of(across_columns_), seam_of(across_rows_)};
}

}  // namespace relief
