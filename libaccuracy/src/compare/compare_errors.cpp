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

const Chart* find_chart(const Experiment& experiment, const std::string& id) {
    const auto& all = experiment.charts;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Chart& one) { return one.id == id; });
    return found == all.end() ? nullptr : &*found;
}

const Curve* find_curve(const Chart* chart, const std::string& method) {
    if (chart == nullptr) return nullptr;
    const auto& all = chart->curves;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Curve& one) { return one.method == method; });
    return found == all.end() ? nullptr : &*found;
}

const CurvePoint* find_point(const Curve& curve, double x) {
    const auto found = std::find_if(curve.points.begin(), curve.points.end(),
                                    [&](const CurvePoint& one) { return is_same_place(one.x, x); });
    return found == curve.points.end() ? nullptr : &*found;
}

std::string place_of(const CurvePoint& point) {
    return fmt::format("at {:.4g}", point.x);
}

ErrorChange change_of(const Experiment& experiment, const Chart& chart, const Curve& before,
                      const Curve& after) {
    ErrorChange change{experiment.id, chart.id, before.method, {}};
    for (const CurvePoint& point : before.points) {
        if (const CurvePoint* same = find_point(after, point.x))
            add_if_changed(change, place_of(point), point.error, same->error);
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
        const Chart* same_chart = find_chart(after, chart.id);
        for (const Curve& curve : chart.curves) {
            const Curve* same = find_curve(same_chart, curve.method);
            if (same == nullptr) continue;
            ErrorChange change = change_of(before, chart, curve, *same);
            if (!change.figures.empty()) changes.push_back(std::move(change));
        }
    }
    return changes;
}

std::vector<std::string> curves_missing_from(const Experiment& other,
                                             const Experiment& experiment) {
    std::vector<std::string> names;
    for (const Chart& chart : experiment.charts) {
        const Chart* same_chart = find_chart(other, chart.id);
        for (const Curve& curve : chart.curves) {
            const std::string name =
                fmt::format("{}, chart {}: {}", experiment.id, chart.id, curve.method);
            const Curve* same = find_curve(same_chart, curve.method);
            if (same == nullptr) names.push_back(name);
            if (same == nullptr) continue;
            for (const CurvePoint& point : curve.points) {
                if (find_point(*same, point.x) == nullptr)
                    names.push_back(name + " " + place_of(point));
            }
        }
    }
    return names;
}

}  // namespace relief
