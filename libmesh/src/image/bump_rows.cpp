// SPDX-License-Identifier: Apache-2.0
// Rows of slopes, pieces of 1024 columns at a time: rows around brought to one (combine_rows), what
// lies beyond the left and right border filled in, columns combined (combine_columns), the slopes
// stored as asked. Beyond the border, smoothing reads the edge again and differences the point
// reflection where the map is clamped: a plane stays a plane. Pieces too steep for float are done
// in double. Tests: tests/mesh/image/bump_test.cpp.
#include "image/bump_rows.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "image/border.h"
#include "image/normal_loops.h"
#include "image/slope_loops.h"

namespace relief {
namespace {

/// What a slope's sum of samples is multiplied by, to the right and upwards.
struct SlopeScales {
    double right, up;
};

SlopeScales scales_of(const GradientKernel& kernel, const BumpOptions& options, int bits) {
    const double largest = bits == 8 ? 255.0 : bits == 16 ? 65535.0 : 1.0;
    const double divisor = kernel.divisor * largest;
    return {options.strength / (divisor * options.texel.x),
            options.strength / (divisor * options.texel.y)};
}

/// Whether float holds both scales with all its digits.
bool are_for_float(const SlopeScales& scales) {
    const auto fits = [](double scale) {
        return scale == 0.0 || (std::abs(scale) > 1e-30 && std::abs(scale) < 1e30);
    };
    return fits(scales.right) && fits(scales.up);
}

/// Finds the rows around a row. Where a clamped border is among them they are copies.
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

    /// Makes `plain()` those around a row, or `copied()` where it returns true.
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

    /// `reflected` for whole rows.
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

/// Slopes of pieces of a row.
template <typename Sample, typename Real>
class SlopePieces {
  public:
    SlopePieces(VectorTarget vectors, const HeightRows& heights, const GradientKernel& kernel,
                const SlopeScales& scales, Wraps wrap)
        : vectors_(vectors),
          width_(heights.width),
          wrap_(wrap.x),
          weights_(kernel),
          rows_(heights, wrap.y, kernel.radius),
          right_scale_(static_cast<Real>(scales.right)),
          up_scale_(static_cast<Real>(scales.up)),
          smoothed_(columns_at_once + 2 * static_cast<std::size_t>(kernel.radius)),
          rise_(smoothed_.size()) {}

    void begin_row(int row) { are_copied_ = rows_.find(row); }

    /// Slopes of columns [first, first + count), to be read from right() and up().
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

/// Stores what is asked of slopes of columns from `first` on.
template <typename Real>
void store(VectorTarget vectors, const BumpTarget& target, int row, std::size_t first,
           std::size_t count, const Real* right, const Real* up) {
    void* const samples = target.row(row);
    if (target.result == BumpResult::slopes)
        return store_slopes(right, up, count, static_cast<float*>(samples) + 2 * first);
    if (target.result == BumpResult::normals)
        return store_normals(vectors, right, up, count, static_cast<float*>(samples) + 3 * first);
    const auto as_codes = [&]<typename Code>(Code* codes) {
        store_codes(vectors, right, up, count, target.format, codes + 3 * first);
    };
    if (target.format.bits == 8)
        as_codes(static_cast<std::uint8_t*>(samples));
    else if (target.format.bits == 16)
        as_codes(static_cast<std::uint16_t*>(samples));
    else
        as_codes(static_cast<float*>(samples));
}

template <typename Sample, typename Real>
bool make_rows(const HeightRows& heights, const BumpOptions& options, const BumpTarget& target,
               int first_row, int last_row) {
    const VectorTarget vectors = best_vector_target();
    const GradientKernel kernel = gradient_kernel(options.kernel, options.gaussian_radius);
    const SlopeScales scales = scales_of(kernel, options, heights.bits);
    SlopePieces<Sample, Real> pieces(vectors, heights, kernel, scales, options.wrap);
    std::optional<SlopePieces<Sample, double>> careful;
    const int step = static_cast<int>(columns_at_once);
    for (int row = first_row; row < last_row; ++row) {
        pieces.begin_row(row);
        for (int first = 0; first < heights.width; first += step) {
            const int count = std::min(step, heights.width - first);
            const auto begin = static_cast<std::size_t>(first);
            const auto size = static_cast<std::size_t>(count);
            pieces.make(first, count);
            if (!any_too_steep(vectors, pieces.right(), pieces.up(), size)) {
                store(vectors, target, row, begin, size, pieces.right(), pieces.up());
                continue;
            }
            if constexpr (std::is_same_v<Real, double>) return false;
            if (!careful) careful.emplace(vectors, heights, kernel, scales, options.wrap);
            careful->begin_row(row);
            careful->make(first, count);
            if (any_too_steep(vectors, careful->right(), careful->up(), size)) return false;
            store(vectors, target, row, begin, size, careful->right(), careful->up());
        }
    }
    return true;
}

template <typename Sample>
bool make_rows_of(const HeightRows& heights, const BumpOptions& options, const BumpTarget& target,
                  int first, int last) {
    const bool is_coarse = target.result == BumpResult::codes && target.format.bits < 32;
    const Arithmetic arithmetic =
        options.arithmetic.value_or(is_coarse ? Arithmetic::float32 : Arithmetic::float64);
    const GradientKernel kernel = gradient_kernel(options.kernel, options.gaussian_radius);
    if (arithmetic == Arithmetic::float32 &&
        are_for_float(scales_of(kernel, options, heights.bits)))
        return make_rows<Sample, float>(heights, options, target, first, last);
    return make_rows<Sample, double>(heights, options, target, first, last);
}

}  // namespace

bool make_bump_rows(const HeightRows& heights, const BumpOptions& options, const BumpTarget& target,
                    int first, int last) {
    switch (heights.bits) {
        case 8:
            return make_rows_of<std::uint8_t>(heights, options, target, first, last);
        case 16:
            return make_rows_of<std::uint16_t>(heights, options, target, first, last);
        default:
            return make_rows_of<float>(heights, options, target, first, last);
    }
}

}  // namespace relief
