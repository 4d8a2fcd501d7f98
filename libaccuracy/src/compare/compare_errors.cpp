// SPDX-License-Identifier: Apache-2.0
// Errors against errors: what is more than rounding. Tests:
// tests/accuracy/compare_reports_test.cpp.
#include "compare/compare_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace relief {
namespace {

/// Sums in another order, or another library's sine, change the last digits.
constexpr double relative_rounding = 1e-6;
/// In the unit of the experiment: nobody sees a billionth of a degree.
constexpr double absolute_rounding = 1e-9;

bool differs(double before, double after) {
    if (std::isnan(before) || std::isnan(after)) return std::isnan(before) != std::isnan(after);
    if (before == after) return false;
    const double size = std::max(std::abs(before), std::abs(after));
    return !(std::abs(after - before) <= std::max(absolute_rounding, relative_rounding * size));
}

/// Places may be tiny, and zero.
bool is_same_place(double a, double b) {
    return std::abs(a - b) <= relative_rounding * std::max(std::abs(a), std::abs(b));
}

void add_if_changed(ErrorChange& change, const std::string& figure, double before, double after) {
    if (differs(before, after)) change.figures.push_back({figure, before, after});
}

ErrorChange change_of(const Experiment& experiment, const Chart& chart, const Curve& before,
                      const Curve& after) {
    ErrorChange change{experiment.id, chart.id, before.method, {}};
    for (const CurvePoint& point : before.points) {
        const auto same =
            std::find_if(after.points.begin(), after.points.end(),
                         [&](const CurvePoint& one) { return is_same_place(one.x, point.x); });
        if (same != after.points.end())
            add_if_changed(change, fmt::format("at {:.4g}", point.x), point.error, same->error);
    }
    return change;
}

}  // namespace

double FigureChange::growth() const {
    if (std::isnan(after)) return std::numeric_limits<double>::infinity();
    if (std::isnan(before)) return -1.0;
    if (before == 0.0) return after > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
    return after / before - 1.0;
}

const FigureChange& ErrorChange::worst() const {
    return *std::max_element(
        figures.begin(), figures.end(),
        [](const FigureChange& a, const FigureChange& b) { return a.growth() < b.growth(); });
}

ErrorChange change_of(const Experiment& experiment, const Measurement& before,
                      const Measurement& after) {
    ErrorChange change{experiment.id, "", before.method, {}};
    const ErrorFigures& old_error = before.error;
    const ErrorFigures& new_error = after.error;
    add_if_changed(change, "rms", old_error.rms, new_error.rms);
    add_if_changed(change, "mean", old_error.mean, new_error.mean);
    add_if_changed(change, "p99", old_error.p99, new_error.p99);
    add_if_changed(change, "max", old_error.max, new_error.max);
    add_if_changed(change, "undefined", static_cast<double>(old_error.undefined),
                   static_cast<double>(new_error.undefined));
    return change;
}

std::vector<ErrorChange> curve_changes(const Experiment& before, const Experiment& after) {
    std::vector<ErrorChange> changes;
    for (const Chart& chart : before.charts) {
        const auto same_chart = std::find_if(after.charts.begin(), after.charts.end(),
                                             [&](const Chart& one) { return one.id == chart.id; });
        if (same_chart == after.charts.end()) continue;
        for (const Curve& curve : chart.curves) {
            const auto same =
                std::find_if(same_chart->curves.begin(), same_chart->curves.end(),
                             [&](const Curve& one) { return one.method == curve.method; });
            if (same == same_chart->curves.end()) continue;
            ErrorChange change = change_of(before, chart, curve, *same);
            if (!change.figures.empty()) changes.push_back(std::move(change));
        }
    }
    return changes;
}

}  // namespace relief
