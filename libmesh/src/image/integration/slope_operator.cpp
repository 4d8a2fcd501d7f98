// SPDX-License-Identifier: Apache-2.0
// Each slope is a difference along one axis of a smoothing across it, so that an image needs four
// operators on lines. Their rows are kept as sparse sums, borders and all; those away from the
// border are the same sum moved along, which runs as a plain loop. In double; sums in a fixed
// order. Tests: tests/mesh/image/integration/heights_from_normals_test.cpp.
#include "image/integration/slope_operator.h"

#include <algorithm>
#include <map>

#include "image/border.h"
#include "parallel.h"

namespace relief {
namespace {

constexpr int rows_at_once = 32;

using Beyond = LineOperator::Beyond;

/// Adds `weight` times the sample at a place that may lie beyond the border.
void add_at(std::map<int, double>& sum, int place, double weight, int count, Wrap wrap,
            Beyond clamped) {
    const bool is_inside = (place >= 0 && place < count) || count == 1;
    if (wrap != Wrap::clamp || clamped == Beyond::last || is_inside) {
        sum[place_within(place, count, wrap)] += weight;
        return;
    }
    // As by reflected() in border.h.
    const int edge = place < 0 ? 0 : count - 1;
    sum[edge] += 2.0 * weight;
    add_at(sum, 2 * edge - place, -weight, count, wrap, clamped);
}

std::vector<Weighted> difference_taps(const GradientKernel& kernel, double texel) {
    std::vector<Weighted> taps;
    for (const HeightDifference& difference : kernel.differences) {
        const double weight = difference.weight / (kernel.divisor * texel);
        taps.push_back({difference.after, weight});
        taps.push_back({difference.before, -weight});
    }
    return taps;
}

std::vector<Weighted> smoothing_taps(const GradientKernel& kernel) {
    std::vector<Weighted> taps{{0, kernel.smoothing.front()}};
    for (std::size_t i = 1; i < kernel.smoothing.size(); ++i) {
        taps.push_back({static_cast<int>(i), kernel.smoothing[i]});
        taps.push_back({-static_cast<int>(i), kernel.smoothing[i]});
    }
    return taps;
}

}  // namespace

LineOperator::LineOperator(int count, std::span<const Weighted> taps, Wrap wrap, Beyond clamped)
    : count_(count) {
    starts_.push_back(0);
    for (int row = 0; row < count; ++row) {
        std::map<int, double> sum;
        for (const Weighted& tap : taps)
            add_at(sum, row + tap.place, tap.weight, count, wrap, clamped);
        for (const auto& [place, weight] : sum)
            entries_.push_back({place, weight});
        starts_.push_back(entries_.size());
    }
    find_inside();
}

LineOperator LineOperator::transposed() const {
    std::vector<std::vector<Weighted>> rows(static_cast<std::size_t>(count_));
    for (int row = 0; row < count_; ++row) {
        for (const Weighted& entry : entries(row))
            rows[static_cast<std::size_t>(entry.place)].push_back({row, entry.weight});
    }
    LineOperator result(count_);
    result.starts_.push_back(0);
    for (const std::vector<Weighted>& row : rows) {
        result.entries_.insert(result.entries_.end(), row.begin(), row.end());
        result.starts_.push_back(result.entries_.size());
    }
    result.find_inside();
    return result;
}

void LineOperator::find_inside() {
    const auto same_moved = [&](int row, int other) {
        const std::span<const Weighted> a = entries(row);
        const std::span<const Weighted> b = entries(other);
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [&](const Weighted& x, const Weighted& y) {
                              return x.place - row == y.place - other && x.weight == y.weight;
                          });
    };
    const int middle = count_ / 2;
    inside_begin_ = middle;
    inside_end_ = middle + 1;
    while (inside_begin_ > 0 && same_moved(inside_begin_ - 1, middle))
        --inside_begin_;
    while (inside_end_ < count_ && same_moved(inside_end_, middle))
        ++inside_end_;
}

void LineOperator::add_to(const double* from, double* to) const {
    const auto add_row = [&](int row) {
        double sum = 0.0;
        for (const Weighted& entry : entries(row))
            sum += entry.weight * from[entry.place];
        to[row] += sum;
    };
    for (int row = 0; row < inside_begin_; ++row)
        add_row(row);
    for (const Weighted& entry : entries(inside_begin_)) {
        const double* moved = from + entry.place;
        double* target = to + inside_begin_;
        const double weight = entry.weight;
        const int inside = inside_end_ - inside_begin_;
        for (int i = 0; i < inside; ++i)
            target[i] += weight * moved[i];
    }
    for (int row = inside_end_; row < count_; ++row)
        add_row(row);
}

SlopeOperator::SlopeOperator(int width, int height, const GradientKernel& kernel, Wraps wrap,
                             glm::dvec2 texel)
    : width_(width),
      height_(height),
      difference_x_(width, difference_taps(kernel, texel.x), wrap.x, Beyond::reflected),
      smoothing_x_(width, smoothing_taps(kernel), wrap.x, Beyond::last),
      // Rows count downwards, slopes upwards.
      difference_y_(height, difference_taps(kernel, -texel.y), wrap.y, Beyond::reflected),
      smoothing_y_(height, smoothing_taps(kernel), wrap.y, Beyond::last),
      difference_x_t_(difference_x_.transposed()),
      smoothing_x_t_(smoothing_x_.transposed()),
      difference_y_t_(difference_y_.transposed()),
      smoothing_y_t_(smoothing_y_.transposed()) {}

void SlopeOperator::slopes(const double* heights, int row, double* along_x, double* along_y) const {
    const auto width = static_cast<std::size_t>(width_);
    std::vector<double> line(width);
    const auto combine = [&](const LineOperator& across, const LineOperator& along, double* to) {
        std::fill(line.begin(), line.end(), 0.0);
        for (const Weighted& entry : across.entries(row)) {
            const double* from = heights + static_cast<std::size_t>(entry.place) * width;
            for (std::size_t i = 0; i < width; ++i)
                line[i] += entry.weight * from[i];
        }
        std::fill_n(to, width, 0.0);
        along.add_to(line.data(), to);
    };
    combine(smoothing_y_, difference_x_, along_x);
    combine(difference_y_, smoothing_x_, along_y);
}

void SlopeOperator::transpose(const SlopeRows& slopes, double* heights) const {
    const auto bands = static_cast<std::size_t>((height_ + rows_at_once - 1) / rows_at_once);
    parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t band = begin; band < end; ++band) {
            const int first = static_cast<int>(band) * rows_at_once;
            transpose_band(slopes, heights, first, std::min(height_, first + rows_at_once));
        }
    });
}

void SlopeOperator::transpose_band(const SlopeRows& slopes, double* heights, int begin,
                                   int end) const {
    const auto width = static_cast<std::size_t>(width_);
    // The rows of slopes that the band needs, each made once.
    std::map<int, std::size_t> place_of_row;
    for (int row = begin; row < end; ++row) {
        for (const LineOperator* across : {&smoothing_y_t_, &difference_y_t_}) {
            for (const Weighted& entry : across->entries(row))
                place_of_row.emplace(entry.place, place_of_row.size());
        }
    }
    std::vector<double> along_x(place_of_row.size() * width), along_y(along_x.size());
    for (const auto& [row, place] : place_of_row)
        slopes(row, &along_x[place * width], &along_y[place * width]);
    std::vector<double> line(width);
    for (int row = begin; row < end; ++row) {
        double* to = heights + static_cast<std::size_t>(row) * width;
        std::fill_n(to, width, 0.0);
        const auto combine = [&](const LineOperator& across, const LineOperator& along,
                                 const std::vector<double>& from) {
            std::fill(line.begin(), line.end(), 0.0);
            for (const Weighted& entry : across.entries(row)) {
                const double* source = &from[place_of_row.at(entry.place) * width];
                for (std::size_t i = 0; i < width; ++i)
                    line[i] += entry.weight * source[i];
            }
            along.add_to(line.data(), to);
        };
        combine(smoothing_y_t_, difference_x_t_, along_x);
        combine(difference_y_t_, smoothing_x_t_, along_y);
    }
}

}  // namespace relief
