// SPDX-License-Identifier: Apache-2.0
// Least-squares heights of a normal map: transpose of the slopes, solved by frequency; where
// borders are clamped, refined by conjugate gradients on the normal equations with the solver by
// frequency as preconditioner [Shewchuk 1994]. Texels and slopes in double, the result in float, in
// the unit of the texel. Tests: tests/mesh/image/integration/heights_from_normals_test.cpp.
#include "relief/mesh/heights_from_normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "accuracy/angle_sum.h"
#include "image/integration/frequency_solver.h"
#include "image/integration/slope_operator.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

using Field = std::vector<double>;

constexpr int most_solver_rounds = 24;
constexpr double enough = 1e-10;  // Of the first error, squared.

/// The slopes of a normal, and what was wrong with it.
struct Slope {
    double x = 0.0, y = 0.0;
    enum class Trouble { none, no_direction, faces_away, too_steep } trouble = Trouble::none;
};

Slope slope_of(const float* normal, double steepest) {
    const double x = normal[0], y = normal[1], z = normal[2];
    if (!std::isfinite(x + y + z) || (x == 0.0 && y == 0.0 && z == 0.0))
        return {0.0, 0.0, Slope::Trouble::no_direction};
    const double across = std::hypot(x, y);
    if (z > 0.0 && across <= steepest * z) return {-x / z, -y / z, Slope::Trouble::none};
    const auto trouble = z > 0.0 ? Slope::Trouble::too_steep : Slope::Trouble::faces_away;
    if (across == 0.0) return {0.0, 0.0, trouble};
    return {-x / across * steepest, -y / across * steepest, trouble};
}

/// Rows of the map's slopes less `mean`; no findings.
SlopeOperator::SlopeRows slopes_of(const Image& normals, double steepest, glm::dvec2 mean) {
    return [&normals, steepest, mean](int row, double* along_x, double* along_y) {
        const auto width = static_cast<std::size_t>(normals.width);
        const float* from = &normals.as<float>()[static_cast<std::size_t>(row) * width * 3];
        for (std::size_t i = 0; i < width; ++i) {
            const Slope slope = slope_of(from + i * 3, steepest);
            along_x[i] = slope.x - mean.x;
            along_y[i] = slope.y - mean.y;
        }
    };
}

void report_trouble(const Image& normals, double steepest, Report& report) {
    const std::size_t count = normals.sample_count() / 3;
    parallel_for_reporting(
        count, 1 << 14, report, [&](std::size_t begin, std::size_t end, Report& found) {
            for (std::size_t texel = begin; texel < end; ++texel) {
                switch (slope_of(&normals.as<float>()[texel * 3], steepest).trouble) {
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

/// Adds up sum(row) in order, rows in parallel.
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

glm::dvec2 mean_slope(const Image& normals, double steepest) {
    const auto width = static_cast<std::size_t>(normals.width);
    const SlopeOperator::SlopeRows slopes = slopes_of(normals, steepest, {0.0, 0.0});
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

/// Solves transpose(slopes(heights)) = `right` to within `enough`. \return rounds
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
    while (round < most_solver_rounds && error > enough * first_error) {
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
        double slope = 0.0, rest = 0.0;  // Squares of slopes, which are no angles.
        AngleMoments angles;
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
    result.residual = {all.angles.rms(), all.angles.mean(), all.angles.max(), all.angles.count()};
}

/// Floats above the lowest.
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
    if (normals.empty()) throw InvalidInput("an empty image holds no normals");
    if (normals.channels != 3 || normals.bits() != 32) {
        throw InvalidInput(fmt::format("normals have 3 float channels, not {} of {} bits",
                                       normals.channels, normals.bits()));
    }
    const auto is_within = [](double value, double least, double greatest) {
        return value >= least && value <= greatest;
    };
    for (const double size : {options.texel.x, options.texel.y}) {
        if (!is_within(size, 1e-30, 1e30))
            throw InvalidInput(fmt::format("a texel of size {} is not within 1e-30 to 1e30", size));
    }
    if (!is_within(options.steepest, 1e-3, 1e6)) {
        throw InvalidInput(
            fmt::format("a steepest slope of {} is not within 0.001 to 1e6", options.steepest));
    }
}

}  // namespace

IntegratedHeights heights_from_normals(const Image& normals, const IntegrationOptions& options,
                                       Report& report) {
    check(normals, options);
    const GradientKernel kernel = gradient_kernel(options.kernel, options.gaussian_radius);
    report_trouble(normals, options.steepest, report);
    IntegratedHeights result;
    result.heights = make_image(normals.width, normals.height, 1, 32, ColorSpace::data);
    const SlopeOperator slopes(normals.width, normals.height, kernel, options.wrap, options.texel);
    const FrequencySolver solver(normals.width, normals.height, kernel, options.wrap,
                                 options.texel);
    result.mean_slope = mean_slope(normals, options.steepest);
    const SlopeOperator::SlopeRows wanted =
        slopes_of(normals, options.steepest, options.level ? result.mean_slope : glm::dvec2(0.0));

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
