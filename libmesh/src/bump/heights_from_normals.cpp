// SPDX-License-Identifier: Apache-2.0
// Least-squares heights of a normal map. Texels and slopes are double, the result is float, in
// units of the texel.
//
// Slope kernels are linear operators on whole images, including the border. Each slope is a
// difference along one axis of a smoothing along the other, so an image needs four operators on
// lines. Their rows are sparse sums; away from the border they are the same sum, which runs as a
// plain loop.
//
// With slopes p = Dx Sy h and q = Sx Dy h, the least-squares heights satisfy
//     (|Dx|^2 |Sy|^2 + |Sx|^2 |Dy|^2) h = Dx' Sy' p + Sx' Dy' q
// The transforms of fft.h turn this into one division per frequency. Most kernels do not respond to
// waves of two texels, and hardly to slightly longer ones. The division would amplify noise there.
// The divisor is therefore increased by `damping` times shortness^4, where shortness is 1 for two
// texels; at eight texels that is 5e-7 of the divisor. For clamped borders, conjugate gradients on
// the normal equations refine the solution, with this solver as preconditioner [Shewchuk 1994].
#include "relief/mesh/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "geometry/error_accumulator.h"
#include "image/fft.h"
#include "image/texel_loops.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// A sample and its weight.
struct Weighted {
    int place;
    double weight;
};

/// A linear map from n samples of a line to n others.
class LineOperator {
  public:
    /// The continuation of a line beyond a clamped border. Differences use the point reflection, so
    /// that planes stay planes; averages repeat the last sample.
    enum class Beyond { reflected, last };

    /// \param taps  offsets from a sample and their weights; `wrap` (bump.h) defines samples beyond
    ///              the border
    LineOperator(int count, std::span<const Weighted> taps, Wrap wrap, Beyond clamped);
    [[nodiscard]] LineOperator transposed() const;

    /// Returns the samples that contribute to one result.
    [[nodiscard]] std::span<const Weighted> entries(int row) const {
        return {entries_.data() + starts_[static_cast<std::size_t>(row)],
                entries_.data() + starts_[static_cast<std::size_t>(row) + 1]};
    }
    /// Adds the result to `to`.
    void add_to(const double* from, double* to) const;
    [[nodiscard]] int count() const { return count_; }

  private:
    explicit LineOperator(int count) : count_(count) {}
    void find_inside();

    int count_;
    std::vector<std::size_t> starts_;
    std::vector<Weighted> entries_;
    /// Rows [inside_begin_, inside_end_) all have the entries of the first one, shifted.
    int inside_begin_ = 0, inside_end_ = 0;
};

/// Computes slopes along x and along y (upwards) of the rows of an image.
class SlopeOperator {
  public:
    SlopeOperator(int width, int height, const GradientKernel& kernel, Wraps wrap,
                  glm::dvec2 texel);

    /// Computes the slopes of one row of heights.
    void slopes(const double* heights, int row, double* along_x, double* along_y) const;

    /// Provides one row of slopes.
    using SlopeRows = std::function<void(int row, double* along_x, double* along_y)>;
    /// Applies the transpose of `slopes`, which gives one number for each height.
    void transpose(const SlopeRows& slopes, double* heights) const;

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

  private:
    void transpose_band(const SlopeRows& slopes, double* heights, int begin, int end) const;

    int width_, height_;
    LineOperator difference_x_, smoothing_x_, difference_y_, smoothing_y_;
    LineOperator difference_x_t_, smoothing_x_t_, difference_y_t_, smoothing_y_t_;
};

constexpr int rows_at_once = 32;

using Beyond = LineOperator::Beyond;

/// Adds `weight` times a sample whose index may lie beyond the border.
void add_at(std::map<int, double>& sum, int place, double weight, int count, Wrap wrap,
            Beyond clamped) {
    const bool is_inside = (place >= 0 && place < count) || count == 1;
    if (wrap != Wrap::clamp || clamped == Beyond::last || is_inside) {
        sum[place_within(place, count, wrap)] += weight;
        return;
    }
    // This is the rule of reflected() in image/texel_loops.h.
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
      // Rows count downwards, but slopes are positive upwards.
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
    // The rows of slopes that the band needs; each is computed once.
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

class FrequencySolver {
  public:
    FrequencySolver(int width, int height, const GradientKernel& kernel, Wraps wrap,
                    glm::dvec2 texel);

    /// Returns whether `solve` is the exact inverse of the slopes followed by their transpose. It
    /// is not at a clamped border, which it treats as mirrored, nor at a mirrored border if the
    /// kernel is asymmetric.
    [[nodiscard]] bool is_exact() const { return is_exact_; }

    /// Transforms the result of SlopeOperator::transpose() into heights of mean 0, in place.
    void solve(double* values) const;

  private:
    /// The squared responses along an axis, by frequency.
    struct Axis {
        RealTransform transform;
        std::vector<double> difference, smoothing, shortness;
        Axis(int count, const GradientKernel& kernel, Wrap wrap, double texel);
    };
    void transform_rows(double* values, bool forward) const;
    void solve_columns(double* values) const;

    Axis x_, y_;
    bool is_exact_;
};

constexpr double damping = 1e-3;
constexpr std::size_t lanes = RealTransform::lanes;

double squared_difference(const GradientKernel& kernel, double frequency, double texel) {
    std::complex<double> sum = 0.0;
    for (const HeightDifference& one : kernel.differences)
        sum += one.weight *
               (std::polar(1.0, frequency * one.after) - std::polar(1.0, frequency * one.before));
    return std::norm(sum / (kernel.divisor * texel));
}

double squared_smoothing(const GradientKernel& kernel, double frequency) {
    double sum = kernel.smoothing.front();
    for (std::size_t i = 1; i < kernel.smoothing.size(); ++i)
        sum += 2.0 * kernel.smoothing[i] * portable::cos(frequency * static_cast<double>(i));
    return sum * sum;
}

/// Returns whether the reversed kernel is the kernel with the opposite sign.
bool is_symmetric(const GradientKernel& kernel) {
    return std::all_of(
        kernel.differences.begin(), kernel.differences.end(),
        [](const HeightDifference& difference) { return difference.before == -difference.after; });
}

FrequencySolver::Axis::Axis(int count, const GradientKernel& kernel, Wrap wrap, double texel)
    : transform(wrap == Wrap::repeat ? TransformKind::hartley : TransformKind::cosine,
                static_cast<std::size_t>(count)) {
    for (std::size_t k = 0; k < transform.length(); ++k) {
        const double frequency = transform.frequency(k);
        const double sine = portable::sin(0.5 * frequency);
        difference.push_back(squared_difference(kernel, frequency, texel));
        smoothing.push_back(squared_smoothing(kernel, frequency));
        shortness.push_back(sine * sine);
    }
}

FrequencySolver::FrequencySolver(int width, int height, const GradientKernel& kernel, Wraps wrap,
                                 glm::dvec2 texel)
    : x_(width, kernel, wrap.x, texel.x),
      y_(height, kernel, wrap.y, texel.y),
      is_exact_((wrap.x == Wrap::repeat && wrap.y == Wrap::repeat) ||
                (wrap.x != Wrap::clamp && wrap.y != Wrap::clamp && is_symmetric(kernel))) {}

void FrequencySolver::solve(double* values) const {
    transform_rows(values, true);
    solve_columns(values);
    transform_rows(values, false);
}

void FrequencySolver::transform_rows(double* values, bool forward) const {
    const std::size_t width = x_.transform.length(), height = y_.transform.length();
    parallel_for((height + lanes - 1) / lanes, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<double> rows(width * lanes), scratch;
        for (std::size_t group = begin; group < end; ++group) {
            const std::size_t first = group * lanes;
            const std::size_t count = std::min(lanes, height - first);
            for (std::size_t lane = 0; lane < count; ++lane) {
                for (std::size_t column = 0; column < width; ++column)
                    rows[column * lanes + lane] = values[(first + lane) * width + column];
            }
            if (forward)
                x_.transform.forward(rows.data(), scratch);
            else
                x_.transform.inverse(rows.data(), scratch);
            for (std::size_t lane = 0; lane < count; ++lane) {
                for (std::size_t column = 0; column < width; ++column)
                    values[(first + lane) * width + column] = rows[column * lanes + lane];
            }
        }
    });
}

void FrequencySolver::solve_columns(double* values) const {
    const std::size_t width = x_.transform.length(), height = y_.transform.length();
    parallel_for((width + lanes - 1) / lanes, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<double> columns(height * lanes), scratch;
        for (std::size_t group = begin; group < end; ++group) {
            const std::size_t first = group * lanes;
            const std::size_t count = std::min(lanes, width - first);
            for (std::size_t row = 0; row < height; ++row)
                std::copy_n(values + row * width + first, count, &columns[row * lanes]);
            y_.transform.forward(columns.data(), scratch);
            for (std::size_t row = 0; row < height; ++row) {
                for (std::size_t lane = 0; lane < count; ++lane) {
                    const std::size_t column = first + lane;
                    const double shortness = 0.5 * (x_.shortness[column] + y_.shortness[row]);
                    const double fourth = shortness * shortness * shortness * shortness;
                    const double seen = x_.difference[column] * y_.smoothing[row] +
                                        x_.smoothing[column] * y_.difference[row];
                    double& value = columns[row * lanes + lane];
                    value = row == 0 && column == 0 ? 0.0 : value / (seen + damping * fourth);
                }
            }
            y_.transform.inverse(columns.data(), scratch);
            for (std::size_t row = 0; row < height; ++row)
                std::copy_n(&columns[row * lanes], count, values + row * width + first);
        }
    });
}

using Field = std::vector<double>;

constexpr int max_rounds = 24;
constexpr double enough = 1e-10;  // Relative to the first error, squared.

/// The slopes of a normal, and its problem.
struct Slope {
    double x = 0.0, y = 0.0;
    enum class Trouble { none, no_direction, faces_away, too_steep } problem = Trouble::none;
};

Slope slope_of(const float* normal, double max_slope) {
    const double x = normal[0], y = normal[1], z = normal[2];
    if (!std::isfinite(x + y + z) || (x == 0.0 && y == 0.0 && z == 0.0))
        return {0.0, 0.0, Slope::Trouble::no_direction};
    const double across = std::sqrt(x * x + y * y);
    if (z > 0.0 && across <= max_slope * z) return {-x / z, -y / z, Slope::Trouble::none};
    const auto problem = z > 0.0 ? Slope::Trouble::too_steep : Slope::Trouble::faces_away;
    if (across == 0.0) return {0.0, 0.0, problem};
    return {-x / across * max_slope, -y / across * max_slope, problem};
}

/// Returns the rows of the map's slopes minus `mean`. Problems are not reported here.
SlopeOperator::SlopeRows slopes_of(const Image& normals, double max_slope, glm::dvec2 mean) {
    return [&normals, max_slope, mean](int row, double* along_x, double* along_y) {
        const auto width = static_cast<std::size_t>(normals.width);
        const float* from = &normals.as<float>()[static_cast<std::size_t>(row) * width * 3];
        for (std::size_t i = 0; i < width; ++i) {
            const Slope slope = slope_of(from + i * 3, max_slope);
            along_x[i] = slope.x - mean.x;
            along_y[i] = slope.y - mean.y;
        }
    };
}

void report_problems(const Image& normals, double max_slope, Report& report) {
    const std::size_t count = normals.sample_count() / 3;
    parallel_for_reporting(
        count, 1 << 14, report, [&](std::size_t begin, std::size_t end, Report& found) {
            for (std::size_t texel = begin; texel < end; ++texel) {
                switch (slope_of(&normals.as<float>()[texel * 3], max_slope).problem) {
                    case Slope::Trouble::none:
                        break;
                    case Slope::Trouble::no_direction:
                        found.add("normal without direction", "texel", texel, "taken as flat");
                        break;
                    case Slope::Trouble::faces_away:
                        found.add("normal facing sideways or back", "texel", texel,
                                  "slope cut to the steepest allowed");
                        break;
                    case Slope::Trouble::too_steep:
                        found.add("normal too steep", "texel", texel,
                                  "slope cut to the steepest allowed");
                        break;
                }
            }
        });
}

/// Adds up sum(row) in the order of the rows. Rows are computed in parallel.
template <typename Sum>
double sum_over_rows(int rows, const Sum& sum) {
    Field sums(static_cast<std::size_t>(rows));
    parallel_for(sums.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            sums[row] = sum(static_cast<int>(row));
    });
    double all = 0.0;
    for (const double one : sums)
        all += one;
    return all;
}

glm::dvec2 mean_slope(const Image& normals, double max_slope) {
    const auto width = static_cast<std::size_t>(normals.width);
    const SlopeOperator::SlopeRows slopes = slopes_of(normals, max_slope, {0.0, 0.0});
    Field x(static_cast<std::size_t>(normals.height)), y(x.size());
    parallel_for(x.size(), 16, [&](std::size_t begin, std::size_t end) {
        Field along_x(width), along_y(width);
        for (std::size_t row = begin; row < end; ++row) {
            slopes(static_cast<int>(row), along_x.data(), along_y.data());
            x[row] = std::accumulate(along_x.begin(), along_x.end(), 0.0);
            y[row] = std::accumulate(along_y.begin(), along_y.end(), 0.0);
        }
    });
    return glm::dvec2(std::accumulate(x.begin(), x.end(), 0.0),
                      std::accumulate(y.begin(), y.end(), 0.0)) /
           (static_cast<double>(width) * static_cast<double>(normals.height));
}

double dot(const Field& a, const Field& b, int rows) {
    const std::size_t width = a.size() / static_cast<std::size_t>(rows);
    return sum_over_rows(rows, [&](int row) {
        const std::size_t first = static_cast<std::size_t>(row) * width;
        double sum = 0.0;
        for (std::size_t i = first; i < first + width; ++i)
            sum += a[i] * b[i];
        return sum;
    });
}

/// to = from * factor + other
void scale_and_add(const Field& from, double factor, const Field& other, Field& to) {
    parallel_for(to.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            to[i] = from[i] * factor + other[i];
    });
}

/// Solves transpose(slopes(heights)) = `right` to within `enough`. \return the number of rounds
int refine(const SlopeOperator& slopes, const FrequencySolver& solver, Field& right,
           Field& heights) {
    const int rows = slopes.height();
    Field& rest = right;
    Field better = rest;
    solver.solve(better.data());
    Field direction = better;
    Field image(rest.size());
    std::fill(heights.begin(), heights.end(), 0.0);
    double error = dot(rest, better, rows);
    const double first_error = error;
    int round = 0;
    while (round < max_rounds && error > enough * first_error) {
        slopes.transpose(
            [&](int row, double* along_x, double* along_y) {
                slopes.slopes(direction.data(), row, along_x, along_y);
            },
            image.data());
        const double step = error / dot(direction, image, rows);
        scale_and_add(direction, step, heights, heights);
        scale_and_add(image, -step, rest, rest);
        better = rest;
        solver.solve(better.data());
        const double next = dot(rest, better, rows);
        scale_and_add(direction, next / error, better, direction);
        error = next;
        ++round;
    }
    return round;
}

void measure_residual(const SlopeOperator& slopes, const SlopeOperator::SlopeRows& wanted,
                      const Field& heights, IntegratedHeights& result) {
    struct Row {
        double slope = 0.0, rest = 0.0;  // Squares of slopes, not of angles.
        ErrorMoments angles;
    };
    const auto width = static_cast<std::size_t>(slopes.width());
    std::vector<Row> rows(static_cast<std::size_t>(slopes.height()));
    parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
        Field x(width), y(width), true_x(width), true_y(width);
        for (std::size_t row = begin; row < end; ++row) {
            slopes.slopes(heights.data(), static_cast<int>(row), x.data(), y.data());
            wanted(static_cast<int>(row), true_x.data(), true_y.data());
            for (std::size_t i = 0; i < width; ++i) {
                const double dx = x[i] - true_x[i], dy = y[i] - true_y[i];
                rows[row].slope += true_x[i] * true_x[i] + true_y[i] * true_y[i];
                rows[row].rest += dx * dx + dy * dy;
                rows[row].angles.add(
                    degrees_between({-x[i], -y[i], 1.0}, {-true_x[i], -true_y[i], 1.0}));
            }
        }
    });
    Row all;
    for (const Row& row : rows) {
        all.slope += row.slope;
        all.rest += row.rest;
        all.angles.add(row.angles);
    }
    const auto count = static_cast<double>(heights.size());
    result.rms_slope = std::sqrt(all.slope / count);
    result.residual_slope = std::sqrt(all.rest / count);
    result.residual = all.angles.stats();
}

/// Stores the heights above the lowest one as floats.
void store(const Field& heights, IntegratedHeights& result) {
    const auto [least, greatest] = std::minmax_element(heights.begin(), heights.end());
    const double lowest = *least;
    result.highest = *greatest - lowest;
    const std::span<float> to = result.heights.as<float>();
    parallel_for(to.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            to[i] = static_cast<float>(heights[i] - lowest);
    });
}

void check(const Image& normals, const IntegrationOptions& options) {
    if (normals.empty()) throw InvalidInput("the normal map is empty");
    if (normals.channels != 3 || normals.bits() != 32) {
        throw InvalidInput(fmt::format("normals have 3 float channels, not {} of {} bits",
                                       normals.channels, normals.bits()));
    }
    const auto is_within = [](double value, double least, double greatest) {
        return value >= least && value <= greatest;
    };
    for (const double size : {options.texel.x, options.texel.y}) {
        if (!is_within(size, 1e-30, 1e30))
            throw InvalidInput(
                fmt::format("the texel size is {}, but must be within [1e-30, 1e30]", size));
    }
    if (!is_within(options.max_slope, 1e-3, 1e6)) {
        throw InvalidInput(fmt::format("the maximum slope is {}, but must be within [0.001, 1e6]",
                                       options.max_slope));
    }
}

}  // namespace

IntegratedHeights heights_from_normals(const Image& normals, const IntegrationOptions& options,
                                       Report& report) {
    check(normals, options);
    const GradientKernel kernel = gradient_kernel(options.kernel, options.gaussian_radius);
    report_problems(normals, options.max_slope, report);
    IntegratedHeights result;
    result.heights = make_image(normals.width, normals.height, 1, 32, ColorSpace::data);
    const SlopeOperator slopes(normals.width, normals.height, kernel, options.wrap, options.texel);
    const FrequencySolver solver(normals.width, normals.height, kernel, options.wrap,
                                 options.texel);
    result.mean_slope = mean_slope(normals, options.max_slope);
    const SlopeOperator::SlopeRows wanted =
        slopes_of(normals, options.max_slope, options.level ? result.mean_slope : glm::dvec2(0.0));

    Field heights(result.heights.sample_count());
    slopes.transpose(wanted, heights.data());
    if (solver.is_exact()) {
        solver.solve(heights.data());
    } else {
        Field right = heights;
        result.rounds = refine(slopes, solver, right, heights);
    }
    measure_residual(slopes, wanted, heights, result);
    store(heights, result);
    return result;
}

}  // namespace relief
