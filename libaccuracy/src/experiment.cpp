// SPDX-License-Identifier: Apache-2.0
// What experiments have in common once they are measured. Tests:
// tests/accuracy/experiment_test.cpp.
#include "relief/accuracy/experiment.h"

#include <cmath>
#include <limits>

#include "relief/mesh/bake_check.h"
#include "relief/mesh/frontier.h"

namespace relief {
namespace {

double time_of(const Measurement& measurement) {
    const Cost& cost = measurement.cost;
    if (cost.one_thread) return cost.one_thread->spread().median;
    if (cost.all_threads) return cost.all_threads->spread().median;
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

ErrorFigures figures_of(const AngleDistribution& angles) {
    return {.count = angles.count,
            .undefined = angles.undefined,
            .rms = angles.rms,
            .mean = angles.mean,
            .p99 = angles.p99,
            .max = angles.max,
            .psnr = {}};
}

ErrorFigures figures_of(const AngleSummary& angles) {
    return {.count = angles.count,
            .undefined = 0,
            .rms = angles.rms,
            .mean = angles.mean,
            .p99 = angles.p99,
            .max = angles.max,
            .psnr = {}};
}

void mark_efficient(Experiment& experiment) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<Price> prices;
    for (const Measurement& one : experiment.measurements)
        prices.push_back({one.error.undefined > 0 ? unknown : one.error.rms, time_of(one)});
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
