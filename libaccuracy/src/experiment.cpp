// SPDX-License-Identifier: Apache-2.0
// Derives figures, efficient methods and convergence orders from measured data.
#include "relief/accuracy/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace relief {
namespace {

constexpr double undefined_error = std::numeric_limits<double>::quiet_NaN();

}  // namespace

ErrorStats nan_if_empty(const ErrorStats& error) {
    if (error.count > 0) return error;
    ErrorStats none = error;
    none.rms = none.mean = none.median = none.p90 = none.p99 = none.max = undefined_error;
    return none;
}

double median_seconds(const Measurement& measurement) {
    if (measurement.cost.one_thread) return measurement.cost.one_thread->spread().median;
    if (measurement.cost.all_threads) return measurement.cost.all_threads->spread().median;
    return std::numeric_limits<double>::quiet_NaN();
}

double curve_error(const ErrorStats& error) {
    return error.undefined > 0 || error.count == 0 ? undefined_error : error.rms;
}

std::vector<bool> pareto_optimal(std::span<const MethodCost> prices) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < prices.size(); ++i) {
        if (!std::isnan(prices[i].error) && !std::isnan(prices[i].time)) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return prices[a].time != prices[b].time ? prices[a].time < prices[b].time
                                                : prices[a].error < prices[b].error;
    });
    std::vector<bool> result(prices.size(), false);
    MethodCost last{std::numeric_limits<double>::infinity(),
                    0.0};  // The slowest Pareto-optimal one so far.
    bool is_first = true;
    for (const std::size_t i : order) {
        const MethodCost& price = prices[i];
        const bool is_equal = !is_first && price.error == last.error && price.time == last.time;
        if (!is_first && !is_equal && price.error >= last.error) continue;
        result[i] = true;
        last = price;
        is_first = false;
    }
    return result;
}

void mark_pareto_optimal(Experiment& experiment) {
    std::vector<MethodCost> prices;
    for (const Measurement& one : experiment.measurements)
        prices.push_back({curve_error(one.error), median_seconds(one)});
    const std::vector<bool> marks = pareto_optimal(prices);
    for (std::size_t i = 0; i < marks.size(); ++i)
        experiment.measurements[i].is_pareto_optimal = marks[i];
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

std::string format_seconds(double seconds) {
    struct Unit {
        double seconds;
        const char* name;
    };
    static constexpr std::array units = {Unit{1e-9, "ns"}, Unit{1e-6, "µs"}, Unit{1e-3, "ms"},
                                         Unit{1.0, "s"}};
    // A value that rounds to 1000 is written in the next unit.
    std::size_t unit = 0;
    while (unit + 1 < units.size() && seconds >= 999.5 * units.at(unit).seconds)
        ++unit;
    const double value = seconds / units.at(unit).seconds;
    const int digits = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f} {}", value, digits, units.at(unit).name);
}

}  // namespace relief
