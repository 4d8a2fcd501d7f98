// SPDX-License-Identifier: Apache-2.0
// Normals, codes and slopes of a height field [Blinn 1978]. Heights that are not finite are
// detected by their slopes; only then are they filled and reported, and all rows are computed
// again.
//
// Rows are computed in parallel, in pieces of 1024 columns. For each piece, the rows are combined,
// the columns beyond the left and right borders are filled in, the columns are combined, and the
// slopes are stored as the requested result. Beyond a clamped border, smoothing repeats the edge
// and differences use the point reflection, so that a plane stays a plane. Pieces that are too
// steep for float are computed in double.
#include "relief/mesh/bump.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "bump/bump_rows.h"
#include "bump/kernel_error_model.h"
#include "image/height_holes.h"
#include "image/normal_coding.h"
#include "image/texel_loops.h"
#include "large_memory.h"
#include "parallel.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The factors of the kernel sums, to the right and upwards.
struct SlopeScales {
    double right, up;
};

GradientKernel kernel_of(const BumpOptions& options) {
    return gradient_kernel(*options.kernel, options.gaussian_radius);
}

SlopeScales scales_of(const HeightRows& heights, const BumpOptions& options) {
    const double largest = heights.bits == 8 ? 255.0 : heights.bits == 16 ? 65535.0 : 1.0;
    const double divisor = kernel_of(options).divisor * largest;
    return {options.strength / (divisor * options.texel.x),
            options.strength / (divisor * options.texel.y)};
}

/// Returns whether float represents both scales at full precision.
bool are_for_float(const SlopeScales& scales) {
    const auto fits = [](double scale) {
        return scale == 0.0 || (std::abs(scale) > 1e-30 && std::abs(scale) < 1e30);
    };
    return fits(scales.right) && fits(scales.up);
}

/// Finds the rows around a row. Rows near a clamped border are copies.
template <typename Sample, typename Real>
class RowFinder {
  public:
    RowFinder(const HeightRows& heights, Wrap wrap, int radius)
        : heights_(heights), wrap_(wrap), radius_(radius) {
        const auto count = static_cast<std::size_t>(2 * radius + 1);
        plain_.steep.resize(count);
        plain_.across.resize(count);
        copied_.steep.resize(count);
        copied_.across.resize(count);
        copies_.resize(2 * count);
    }

    /// Sets plain() to the rows around a row, or copied() if it returns true.
    bool find(int row) {
        const bool inside = row >= radius_ && row + radius_ < heights_.height;
        const bool copy = wrap_ == Wrap::clamp && !inside;
        for (int offset = -radius_; offset <= radius_; ++offset) {
            const auto at = static_cast<std::size_t>(radius_ + offset);
            if (copy) {
                copies_[2 * at] = reflected_row(row + offset);
                copies_[2 * at + 1] = read(place_within(row + offset, heights_.height, wrap_));
                copied_.steep[at] = copies_[2 * at].data();
                copied_.across[at] = copies_[2 * at + 1].data();
            } else {
                const int place = place_within(row + offset, heights_.height, wrap_);
                plain_.steep[at] = plain_.across[at] =
                    static_cast<const Sample*>(heights_.row(place));
            }
        }
        return copy;
    }
    [[nodiscard]] const RowsAround<Sample>& plain() const { return plain_; }
    [[nodiscard]] const RowsAround<Real>& copied() const { return copied_; }

  private:
    [[nodiscard]] std::vector<Real> read(int row) const {
        const auto* samples = static_cast<const Sample*>(heights_.row(row));
        return std::vector<Real>(samples, samples + heights_.width);
    }

    /// Applies reflected() to a whole row.
    [[nodiscard]] std::vector<Real> reflected_row(int row) const {
        if (row >= 0 && row < heights_.height) return read(row);
        if (heights_.height == 1) return read(0);
        const int edge = row < 0 ? 0 : heights_.height - 1;
        std::vector<Real> result = read(edge);
        const std::vector<Real> inner = reflected_row(2 * edge - row);
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] = 2 * result[i] - inner[i];
        return result;
    }

    const HeightRows& heights_;
    Wrap wrap_;
    int radius_;
    RowsAround<Sample> plain_;
    RowsAround<Real> copied_;
    std::vector<std::vector<Real>> copies_;
};

/// Returns the weights for codes_3x3(), if the kernel has that form.
std::optional<Weights3x3> scaled_weights_3x3(const KernelWeights<float>& weights, float right_scale,
                                             float up_scale) {
    const auto& differences = weights.differences;
    const bool fits = differences.size() == 1 && differences[0].before == -1 &&
                      differences[0].after == 1 && differences[0].weight == 1.0F &&
                      weights.smoothing.size() <= 2;
    if (!fits) return {};
    return Weights3x3{weights.smoothing[0],
                      weights.smoothing.size() == 2 ? weights.smoothing[1] : 0.0F, right_scale,
                      up_scale};
}

/// Computes the slopes of pieces of a row.
template <typename Sample, typename Real>
class SlopePieces {
  public:
    SlopePieces(VectorTarget vectors, const HeightRows& heights, const BumpOptions& options)
        : vectors_(vectors),
          width_(heights.width),
          wrap_(options.wrap->x),
          weights_(kernel_of(options)),
          rows_(heights, options.wrap->y, static_cast<int>(weights_.radius)),
          right_scale_(static_cast<Real>(scales_of(heights, options).right)),
          up_scale_(static_cast<Real>(scales_of(heights, options).up)),
          smoothed_(columns_at_once + 2 * static_cast<std::size_t>(weights_.radius)),
          rise_(smoothed_.size()) {}

    void begin_row(int row) { are_copied_ = rows_.find(row); }

    /// Computes the slopes of columns [first, first + count) into right() and up().
    void make(int first, int count) {
        const int radius = static_cast<int>(weights_.radius);
        const int begin = std::max(first - radius, 0);
        const int end = std::min(first + count + radius, width_);
        const auto at = [&](int column) {
            return static_cast<std::size_t>(column - first + radius);
        };
        combine(begin, end - begin, &smoothed_[at(begin)], &rise_[at(begin)]);
        for (int column = first - radius; column < begin; ++column)
            fill_beyond(column, smoothed_[at(column)], rise_[at(column)]);
        for (int column = end; column < first + count + radius; ++column)
            fill_beyond(column, smoothed_[at(column)], rise_[at(column)]);
        combine_columns(vectors_, weights_, &smoothed_[at(first)], &rise_[at(first)],
                        static_cast<std::size_t>(count), right_scale_, up_scale_, right_.data(),
                        up_.data());
    }
    /// Returns the scaled weights, if the kernel is a 3x3 kernel.
    [[nodiscard]] std::optional<Weights3x3> weights_3x3()
        const requires std::is_same_v<Real, float> {
        return scaled_weights_3x3(weights_, right_scale_, up_scale_);
    }
    [[nodiscard]] const Real* right() const { return right_.data(); }
    [[nodiscard]] const Real* up() const { return up_.data(); }

  private:
    void combine(int first, int count, Real* smoothed, Real* rise) const {
        const auto begin = static_cast<std::size_t>(first);
        const auto size = static_cast<std::size_t>(count);
        if (are_copied_)
            combine_rows(vectors_, rows_.copied(), weights_, begin, size, smoothed, rise);
        else
            combine_rows(vectors_, rows_.plain(), weights_, begin, size, smoothed, rise);
    }

    void fill_beyond(int column, Real& smoothed, Real& rise) const {
        Real unused{};
        combine(place_within(column, width_, wrap_), 1, &smoothed, &rise);
        if (wrap_ != Wrap::clamp) return;
        smoothed = reflected(column, width_, [&](int place) {
            Real value{};
            combine(place, 1, &value, &unused);
            return value;
        });
    }

    VectorTarget vectors_;
    int width_;
    Wrap wrap_;
    KernelWeights<Real> weights_;
    RowFinder<Sample, Real> rows_;
    bool are_copied_ = false;
    Real right_scale_, up_scale_;
    std::vector<Real> smoothed_, rise_;
    std::array<Real, columns_at_once> right_{}, up_{};
};

template <typename Real>
void store_slopes(const Real* right, const Real* up, std::size_t count, float* slopes) {
    for (std::size_t i = 0; i < count; ++i) {
        // Adding zero turns -0 into 0.
        slopes[2 * i] = static_cast<float>(right[i] + 0);
        slopes[2 * i + 1] = static_cast<float>(up[i] + 0);
    }
}

/// Calls with_codes(pointer to the first sample of a texel) with the sample type of the format.
template <typename WithCodes>
void at_codes(const BumpTarget& target, int row, int column, const WithCodes& with_codes) {
    void* const samples = target.row(row);
    const std::ptrdiff_t offset = std::ptrdiff_t{3} * column;
    if (target.format.bits == 8)
        with_codes(static_cast<std::uint8_t*>(samples) + offset);
    else if (target.format.bits == 16)
        with_codes(static_cast<std::uint16_t*>(samples) + offset);
    else
        with_codes(static_cast<float*>(samples) + offset);
}

/// Stores the requested result of slopes, for columns from `first` on.
template <typename Real>
void store(VectorTarget vectors, const BumpTarget& target, int row, int first, std::size_t count,
           const Real* right, const Real* up) {
    const auto floats = [&](int channels) {
        return static_cast<float*>(target.row(row)) + std::ptrdiff_t{channels} * first;
    };
    switch (target.result) {
        case BumpResult::slopes:
            return store_slopes(right, up, count, floats(2));
        case BumpResult::normals:
            return store_normals(vectors, right, up, count, floats(3));
        case BumpResult::codes:
            return at_codes(target, row, first, [&]<typename Sample>(Sample* codes) {
                if constexpr (!std::is_same_v<Sample, float>) {
                    if (target.format.dither != Dither::none) {
                        const DitherRow thresholds(target.format.dither, row);
                        return store_dithered_codes(right, up, count, target.format,
                                                    static_cast<std::size_t>(first), thresholds,
                                                    codes);
                    }
                }
                store_codes(vectors, right, up, count, target.format, codes);
            });
    }
}

/// Calls make(first, count) for the pieces of a row until one returns false.
template <typename Make>
bool all_pieces(int width, const Make& make) {
    const int step = static_cast<int>(columns_at_once);
    for (int first = 0; first < width; first += step) {
        if (!make(first, std::min(step, width - first))) return false;
    }
    return true;
}

/// Computes rows with any kernel. Functions return false if a height is not finite.
template <typename Sample, typename Real>
class RowMaker {
  public:
    RowMaker(VectorTarget vectors, const HeightRows& heights, const BumpOptions& options,
             const BumpTarget& target)
        : vectors_(vectors),
          heights_(heights),
          options_(options),
          target_(target),
          slopes_(vectors, heights, options) {}

    bool make_row(int row) {
        begin_row(row);
        return all_pieces(heights_.width,
                          [&](int first, int count) { return make_piece(first, count); });
    }
    void begin_row(int row) {
        row_ = row;
        slopes_.begin_row(row);
    }
    bool make_piece(int first, int count) {
        const auto size = static_cast<std::size_t>(count);
        slopes_.make(first, count);
        if (!any_too_steep(vectors_, slopes_.right(), slopes_.up(), size)) {
            store(vectors_, target_, row_, first, size, slopes_.right(), slopes_.up());
            return true;
        }
        if constexpr (std::is_same_v<Real, double>)
            return false;
        else
            return make_in_double(row_, first, count);
    }
    /// Computes a piece in double.
    bool make_in_double(int row, int first, int count) {
        if (!in_double_) {
            in_double_ =
                std::make_unique<RowMaker<Sample, double>>(vectors_, heights_, options_, target_);
        }
        in_double_->begin_row(row);
        return in_double_->make_piece(first, count);
    }
    [[nodiscard]] const SlopePieces<Sample, Real>& slopes() const { return slopes_; }

  private:
    VectorTarget vectors_;
    const HeightRows& heights_;
    const BumpOptions& options_;
    const BumpTarget& target_;
    int row_ = 0;
    SlopePieces<Sample, Real> slopes_;
    std::unique_ptr<RowMaker<Sample, double>> in_double_;
};

/// Rows of heights as floats. Integers are converted; three rows are kept, so that each is
/// converted once.
template <typename Sample>
class FloatRows {
  public:
    explicit FloatRows(const HeightRows& heights) : heights_(heights) {}

    /// Returns the rows above, at and below a row (after wrapping). They are valid until the next
    /// call.
    std::array<const float*, 3> around(int row, Wrap wrap);

  private:
    struct Slot {
        int row = -1;
        std::vector<float> samples;
    };
    const float* load(int row, const std::array<int, 3>& needed);

    const HeightRows& heights_;
    std::array<Slot, 3> slots_;
};

template <typename Sample>
const float* FloatRows<Sample>::load(int row, const std::array<int, 3>& needed) {
    const auto* const samples = static_cast<const Sample*>(heights_.row(row));
    if constexpr (std::is_same_v<Sample, float>) {
        return samples;
    } else {
        const auto has_row = [row](const Slot& slot) { return slot.row == row; };
        const auto loaded = std::find_if(slots_.begin(), slots_.end(), has_row);
        if (loaded != slots_.end()) return loaded->samples.data();
        // A slot that holds none of the needed rows; one exists, because no slot holds `row`.
        Slot& slot = *std::find_if(slots_.begin(), slots_.end(), [&](const Slot& candidate) {
            return std::find(needed.begin(), needed.end(), candidate.row) == needed.end();
        });
        slot.samples.assign(samples, samples + heights_.width);
        slot.row = row;
        return slot.samples.data();
    }
}

template <typename Sample>
std::array<const float*, 3> FloatRows<Sample>::around(int row, Wrap wrap) {
    const std::array<int, 3> needed = {place_within(row - 1, heights_.height, wrap), row,
                                       place_within(row + 1, heights_.height, wrap)};
    std::array<const float*, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i)
        rows[i] = load(needed[i], needed);
    return rows;
}

/// Computes rows of codes with 3x3 kernels in one loop, and clamped borders with a RowMaker.
template <typename Sample>
class DirectRowMaker {
  public:
    DirectRowMaker(VectorTarget vectors, const HeightRows& heights, const Wraps& wrap,
                   const Weights3x3& weights, const BumpTarget& target,
                   RowMaker<Sample, float>& general)
        : vectors_(vectors),
          heights_(heights),
          wrap_(wrap),
          weights_(weights),
          target_(target),
          general_(general),
          rows_(heights) {}

    bool make_row(int row) {
        const bool at_border = row == 0 || row == heights_.height - 1;
        if (wrap_.y == Wrap::clamp && at_border) return general_.make_row(row);
        const bool finite =
            !encode_row(row) || all_pieces(heights_.width, [&](int first, int count) {
                return general_.make_in_double(row, first, count);
            });
        if (!finite || wrap_.x != Wrap::clamp) return finite;
        general_.begin_row(row);
        return general_.make_piece(0, 1) && general_.make_piece(heights_.width - 1, 1);
    }

  private:
    /// Distance of heights that are prefetched, in texels.
    static constexpr int heights_ahead = 512;

    /// Returns whether a slope is too steep for float.
    bool encode_row(int row) {
        Rows3x3 rows{.rows = rows_.around(row, wrap_.y)};
        const int before = place_within(-1, heights_.width, wrap_.x);
        const int after = place_within(heights_.width, heights_.width, wrap_.x);
        for (std::size_t i = 0; i < 3; ++i) {
            rows.left[i] = rows.rows[i][before];
            rows.right[i] = rows.rows[i][after];
        }
        // Floats of the row below are read for the first time. Integers of that row were converted,
        // and the row after it follows if rows are contiguous.
        const int below = place_within(row + 1, heights_.height, wrap_.y);
        rows.next = static_cast<const Sample*>(heights_.row(below)) +
                    (std::is_same_v<Sample, float> ? heights_ahead : heights_.width);
        rows.next_size = sizeof(Sample);
        bool too_steep = false;
        at_codes(target_, row, 0, [&]<typename Code>(Code* codes) {
            if constexpr (!std::is_same_v<Code, float>) {
                too_steep =
                    codes_3x3(vectors_, rows, weights_, static_cast<std::size_t>(heights_.width),
                              target_.format, codes);
            }
        });
        return too_steep;
    }

    VectorTarget vectors_;
    const HeightRows& heights_;
    Wraps wrap_;
    Weights3x3 weights_;
    const BumpTarget& target_;
    RowMaker<Sample, float>& general_;
    FloatRows<Sample> rows_;
};

template <typename Maker>
bool make_with(Maker& maker, int first, int last) {
    for (int row = first; row < last; ++row) {
        if (!maker.make_row(row)) return false;
    }
    return true;
}

template <typename Sample>
bool make_rows(const HeightRows& heights, const BumpOptions& options, const BumpTarget& target,
               int first, int last) {
    const VectorTarget vectors = best_vector_target();
    const bool has_few_bits = target.result == BumpResult::codes && target.format.bits < 32;
    const Arithmetic arithmetic =
        options.arithmetic.value_or(has_few_bits ? Arithmetic::float32 : Arithmetic::float64);
    if (arithmetic == Arithmetic::float64 || !are_for_float(scales_of(heights, options))) {
        RowMaker<Sample, double> maker(vectors, heights, options, target);
        return make_with(maker, first, last);
    }
    RowMaker<Sample, float> maker(vectors, heights, options, target);
    const std::optional<Weights3x3> weights = maker.slopes().weights_3x3();
    const bool is_dithered = target.format.dither != Dither::none;
    if (!weights || !has_few_bits || is_dithered) return make_with(maker, first, last);
    DirectRowMaker<Sample> direct(vectors, heights, *options.wrap, *weights, target, maker);
    return make_with(direct, first, last);
}

}  // namespace

bool detail::make_bump_rows(const HeightRows& heights, const BumpOptions& options,
                            const BumpTarget& target, int first, int last) {
    switch (heights.bits) {
        case 8:
            return make_rows<std::uint8_t>(heights, options, target, first, last);
        case 16:
            return make_rows<std::uint16_t>(heights, options, target, first, last);
        default:
            return make_rows<float>(heights, options, target, first, last);
    }
}

namespace {

// Differences of floats reach 7e38. With these limits, squares of slopes stay within the range of
// double.
constexpr double max_strength = 1e30;
constexpr double max_texel = 1e30;

void check(const ImageView& height, const BumpOptions& options) {
    if (height.empty()) throw InvalidInput("the height field is empty");
    if (height.channels != 1)
        throw InvalidInput(fmt::format("a height field has one channel, not {}", height.channels));
    check_bump(options);
}

/// Computes rows of a map of two or four channels: a few rows at a time are computed with three
/// channels, in memory that stays in the cache of the processor, and copied.
template <typename Sample>
bool make_spread_rows(const HeightRows& heights, const BumpOptions& options,
                      const NormalMapFormat& format, const MutableImageView& map, int first,
                      int last) {
    constexpr int texels_at_once = 1 << 15;
    const int max_rows = std::max(1, texels_at_once / heights.width);
    const auto width = static_cast<std::size_t>(heights.width);
    const auto count = static_cast<std::size_t>(std::min(max_rows, last - first));
    std::vector<Sample> threes(3 * width * count + 1);
    for (int begin = first; begin < last; begin += max_rows) {
        const int end = std::min(begin + max_rows, last);
        const auto row_of = [&](int row) {
            return threes.data() + 3 * width * static_cast<std::size_t>(row - begin);
        };
        if (!make_bump_rows(heights, options, {BumpResult::codes, format, row_of}, begin, end))
            return false;
        for (int row = begin; row < end; ++row)
            spread_samples(row_of(row), width, map.channels, map.row<Sample>(row));
    }
    return true;
}

using MakeRows =
    std::function<bool(const HeightRows& heights, const BumpOptions& options, int first, int last)>;

/// Computes all rows in parallel. Returns false if a height is not finite.
bool make_all_rows(const HeightRows& heights, const BumpOptions& options, const MakeRows& make) {
    const std::size_t grain =
        std::max<std::size_t>(1, bump_texels_per_piece / static_cast<std::size_t>(heights.width));
    std::atomic<bool> finite = true;
    parallel_for(static_cast<std::size_t>(heights.height), grain,
                 [&](std::size_t begin, std::size_t end) {
                     if (!make(heights, options, static_cast<int>(begin), static_cast<int>(end)))
                         finite = false;
                 });
    return finite;
}

template <typename Sample>
std::function<const void*(int)> rows_of(std::span<const Sample> samples, int width) {
    return [=](int row) { return samples.data() + static_cast<std::ptrdiff_t>(row) * width; };
}

/// Computes all rows of an image. If it has holes, the rows are computed from a filled copy.
void make_image_rows(const ImageView& height, const BumpOptions& given, const MakeRows& make,
                     Report& report) {
    const BumpOptions options = resolve_options(height, given);
    HeightRows heights{height.width, height.height, height.bits(), {}};
    with_sample_type(height, [&]<typename Sample>(Sample) {
        heights.row = [&height](int row) { return height.row<Sample>(row); };
    });
    if (make_all_rows(heights, options, make)) return;
    const Image whole = part_of(height, {0, 0, height.width, height.height});
    const std::vector<float> filled = filled_holes(whole, *options.wrap, report);
    heights.row = rows_of(std::span(filled), height.width);
    make_all_rows(heights, options, make);
}

MakeRows make_into(const BumpTarget& target) {
    return [target](const HeightRows& heights, const BumpOptions& options, int first, int last) {
        return make_bump_rows(heights, options, target, first, last);
    };
}

/// The rows of an image as a target.
template <typename Sample>
std::function<void*(int)> target_rows(const MutableImageView& image) {
    return [image](int row) { return image.row<Sample>(row); };
}

Image floats_from_height(const Image& height, int channels, BumpResult result,
                         const BumpOptions& options, Report& report) {
    check(height, options);
    Image image = make_image(height.width, height.height, channels, 32, ColorSpace::data);
    make_image_rows(height, options, make_into({result, {}, target_rows<float>(image)}), report);
    return image;
}

/// Returns an image in large memory pages, because all of it will be written.
template <typename Sample>
Image image_to_fill(int width, int height, int channels) {
    Image image{width, height, channels, ColorSpace::data, {}};
    std::vector<Sample> samples;
    reserve_to_fill(samples, image.sample_count());
    samples.resize(image.sample_count());
    image.samples = std::move(samples);
    return image;
}

Image image_to_fill(int width, int height, int channels, int bits) {
    if (bits == 8) return image_to_fill<std::uint8_t>(width, height, channels);
    if (bits == 16) return image_to_fill<std::uint16_t>(width, height, channels);
    if (bits == 32) return image_to_fill<float>(width, height, channels);
    return make_image(width, height, channels, bits, ColorSpace::data);  // Throws.
}

}  // namespace

void detail::check_bump(const BumpOptions& options) {
    if (!(std::abs(options.strength) <= max_strength)) {
        throw InvalidInput(fmt::format("the strength is {}, but must be within +-{}",
                                       options.strength, max_strength));
    }
    for (const double size : {options.texel.x, options.texel.y}) {
        if (!(size >= 1.0 / max_texel && size <= max_texel)) {
            throw InvalidInput(fmt::format("the texel size is {}, but must be within [{}, {}]",
                                           size, 1.0 / max_texel, max_texel));
        }
    }
    gradient_kernel(options.kernel.value_or(Kernel::gaussian), options.gaussian_radius);
}

BumpOptions resolve_options(const ImageView& height, BumpOptions options) {
    check(height, options);
    if (!options.wrap) options.wrap = detect_tiling(height).wraps();
    if (!options.kernel) {
        const KernelPrediction best = best_kernel(height, options);
        options.kernel = best.kernel;
        options.gaussian_radius = best.gaussian_radius;
    }
    return options;
}

Image normals_from_height(const Image& height, const BumpOptions& options, Report& report) {
    return floats_from_height(height, 3, BumpResult::normals, options, report);
}

Image slopes_from_height(const Image& height, const BumpOptions& options, Report& report) {
    return floats_from_height(height, 2, BumpResult::slopes, options, report);
}

void normal_map_from_height(const Image& height, const BumpOptions& options,
                            const NormalMapFormat& format, Image& result, Report& report) {
    check(height, options);
    const bool fits = result.width == height.width && result.height == height.height &&
                      result.channels == 3 && result.bits() == format.bits;
    if (!fits) result = image_to_fill(height.width, height.height, 3, format.bits);
    result.color_space = ColorSpace::data;
    normal_map_from_height(height, options, format, MutableImageView(result), report);
}

void normal_map_from_height(const ImageView& height, const BumpOptions& options,
                            const NormalMapFormat& format, const MutableImageView& result,
                            Report& report, const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    check(height, options);
    check_target(result, height, format.bits, 2, 4, "normal map");
    with_sample_type(result, [&]<typename Sample>(Sample) {
        if (result.channels == 3) {
            const BumpTarget target{BumpResult::codes, format, target_rows<Sample>(result)};
            return make_image_rows(height, options, make_into(target), report);
        }
        const auto make = [&](const HeightRows& heights, const BumpOptions& resolved, int first,
                              int last) {
            return make_spread_rows<Sample>(heights, resolved, format, result, first, last);
        };
        make_image_rows(height, options, make, report);
    });
}

Image normal_map_from_height(const Image& height, const BumpOptions& options,
                             const NormalMapFormat& format, Report& report) {
    Image result;
    normal_map_from_height(height, options, format, result, report);
    return result;
}

}  // namespace relief
