// SPDX-License-Identifier: Apache-2.0
// What experiments have in common once they are measured. Tests:
// tests/accuracy/experiment_test.cpp.
#include "relief/accuracy/experiment.h"

#include <cmath>
#include <limits>

#include "measured_methods.h"
#include "relief/mesh/frontier.h"

namespace relief {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// \param angles  what an AngleDistribution and an AngleSummary have in common; of no angle both
///                say 0, which would be exactly right
template <typename Angles>
ErrorFigures figures_of_summary(const Angles& angles, std::size_t undefined) {
    if (angles.count == 0)
        return {.undefined = undefined,
                .rms = not_known,
                .mean = not_known,
                .p99 = not_known,
                .max = not_known};
    return {.count = angles.count,
            .undefined = undefined,
            .rms = angles.rms,
            .mean = angles.mean,
            .p99 = angles.p99,
            .max = angles.max};
}

}  // namespace

ErrorFigures figures_of(const AngleDistribution& angles) {
    return figures_of_summary(angles, angles.undefined);
}

ErrorFigures figures_of(const AngleSummary& angles) {
    return figures_of_summary(angles, 0);
}

double curve_error(const ErrorFigures& error) {
    return error.undefined > 0 ? not_known : error.rms;
}

double curve_error(const AngleDistribution& angles) {
    return curve_error(figures_of(angles));
}

void mark_efficient(Experiment& experiment) {
    std::vector<Price> prices;
    for (const Measurement& one : experiment.measurements)
        prices.push_back({curve_error(one.error), median_seconds(one)});
    const std::vector<bool> marks = efficient(prices);
    for (std::size_t i = 0; i < marks.size(); ++i)
        experiment.measurements[i].is_efficient = marks[i];
}

std::optional<double> fitted_order(const std::vector<CurvePoint>& points) {
    double count = 0.0;
    double sum_x = 0.0;
    double sum_y = 0.0;
    double sum_xx = 0.0;
    double sum_xy = 0.0;
    for (const CurvePoint& point : points) {
        const double x = std::log(point.x);
        const double y = std::log(point.error);
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        count += 1.0;
        sum_x += x;
        sum_y += y;
        sum_xx += x * x;
        sum_xy += x * y;
    }
    const double spread = count * sum_xx - sum_x * sum_x;
    if (count < 2.0 || spread <= 1e-12 * count * sum_xx) return std::nullopt;
    return (count * sum_xy - sum_x * sum_y) / spread;
}

}  // namespace relief
