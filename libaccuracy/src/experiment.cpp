// SPDX-License-Identifier: Apache-2.0
// Derives figures, efficient methods and convergence orders from measured data; matches the methods
// of two runs by experiment and name, and judges their errors, times and memory.
#include "relief/accuracy/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <tuple>

#include "portable_math.h"

namespace relief::accuracy {
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

RatioInterval median_interval(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto count = static_cast<double>(values.size());
    // The number of values below the median has a binomial distribution, here as a normal one.
    const double outside = std::floor((count + 1.0 - 1.96 * std::sqrt(count)) / 2.0);
    const auto first = static_cast<std::size_t>(std::max(outside - 1.0, 0.0));
    return {quantile(values, 0.5), values[first], values[values.size() - 1 - first]};
}

namespace {

/// Returns whether a method is faster than another one, and not tied.
bool is_faster(const MethodCost& one, const MethodCost& other) {
    if (one.rounds.empty() || one.rounds.size() != other.rounds.size())
        return one.time < other.time;
    std::vector<double> ratios;
    for (std::size_t i = 0; i < one.rounds.size(); ++i)
        ratios.push_back(one.rounds[i] / other.rounds[i]);
    return median_interval(std::move(ratios)).high < 1.0 / equal_time_ratio;
}

}  // namespace

std::vector<bool> pareto_optimal(std::span<const MethodCost> costs) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < costs.size(); ++i) {
        if (!std::isnan(costs[i].error) && !std::isnan(costs[i].time)) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(costs[a].error, costs[a].time) < std::tie(costs[b].error, costs[b].time);
    });
    std::vector<bool> result(costs.size(), false);
    for (auto one = order.begin(); one != order.end(); ++one) {
        result[*one] = std::all_of(order.begin(), one, [&](std::size_t other) {
            const bool is_tied =
                costs[*one].error == costs[other].error && !is_faster(costs[other], costs[*one]);
            return !result[other] || is_tied || is_faster(costs[*one], costs[other]);
        });
    }
    return result;
}

void mark_pareto_optimal(Experiment& experiment) {
    std::vector<MethodCost> costs;
    for (const Measurement& one : experiment.measurements) {
        const auto& timing = one.cost.one_thread ? one.cost.one_thread : one.cost.all_threads;
        costs.push_back({curve_error(one.error), median_seconds(one),
                         timing ? timing->rounds : std::vector<double>()});
    }
    const std::vector<bool> marks = pareto_optimal(costs);
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
        const double x = relief::detail::portable::log(point.x);
        const double y = relief::detail::portable::log(point.error);
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

double FigureChange::growth() const {
    if (std::isnan(after)) return std::numeric_limits<double>::infinity();
    if (std::isnan(before)) return -1.0;
    if (before == 0.0) return after > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
    return after / before - 1.0;
}

std::string MethodChange::name() const {
    return fmt::format("{}{}: {}", experiment, chart.empty() ? "" : ", chart " + chart, method);
}

const FigureChange& MethodChange::worst() const {
    return *std::max_element(
        figures.begin(), figures.end(),
        [](const FigureChange& a, const FigureChange& b) { return a.growth() < b.growth(); });
}

namespace {

/// Another order of summation or another math library changes the last digits by less.
constexpr double relative_rounding = 1e-6;
/// Smaller changes are invisible, in the unit of any experiment.
constexpr double absolute_rounding = 1e-9;

bool differs(double before, double after) {
    if (std::isnan(before) || std::isnan(after)) return std::isnan(before) != std::isnan(after);
    if (before == after) return false;
    const double size = std::max(std::abs(before), std::abs(after));
    return !(std::abs(after - before) <= std::max(absolute_rounding, relative_rounding * size));
}

/// The first element whose `name` is `value`, or nullptr.
template <typename Element>
const Element* find_by(std::string Element::*name, const std::string& value,
                       const std::vector<Element>& all) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Element& one) { return one.*name == value; });
    return found == all.end() ? nullptr : &*found;
}

/// The errors of all methods and curves, as figures that did not change.
std::vector<MethodChange> figures_of(const Experiment& experiment) {
    std::vector<MethodChange> all;
    for (const Measurement& one : experiment.measurements) {
        const ErrorStats& error = one.error;
        MethodChange& figures = all.emplace_back(MethodChange{experiment.id, "", one.method, {}});
        for (const auto& [name, value] :
             {std::pair("rms", error.rms), std::pair("mean", error.mean),
              std::pair("p99", error.p99), std::pair("max", error.max),
              std::pair("undefined", static_cast<double>(error.undefined))})
            figures.figures.push_back({name, value, value});
    }
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            MethodChange& figures =
                all.emplace_back(MethodChange{experiment.id, chart.id, curve.method, {}});
            for (const CurvePoint& point : curve.points)
                figures.figures.push_back(
                    {fmt::format("at {:.4g}", point.x), point.error, point.error});
        }
    }
    return all;
}

/// The same method or curve, or nullptr.
const MethodChange* same_in(const std::vector<MethodChange>& all, const MethodChange& one) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const MethodChange& other) {
        return other.chart == one.chart && other.method == one.method;
    });
    return found == all.end() ? nullptr : &*found;
}

/// Adds the methods, curves and points of an experiment that the other run does not have. Without
/// the experiment these are all methods.
void add_missing(std::vector<std::string>& names, const Experiment& experiment,
                 const Experiment* other) {
    const std::vector<MethodChange> others =
        other == nullptr ? std::vector<MethodChange>() : figures_of(*other);
    for (const MethodChange& figures : figures_of(experiment)) {
        const MethodChange* same = same_in(others, figures);
        if (same == nullptr && (other != nullptr || figures.chart.empty()))
            names.push_back(figures.name());
        if (same == nullptr) continue;
        for (const FigureChange& one : figures.figures) {
            if (find_by(&FigureChange::figure, one.figure, same->figures) == nullptr)
                names.push_back(figures.name() + " " + one.figure);
        }
    }
}

/// Adds the methods and curves of both runs that differ, with the figures that differ.
void add_changes(std::vector<MethodChange>& changes, const Experiment& before,
                 const Experiment& after) {
    const std::vector<MethodChange> others = figures_of(after);
    for (MethodChange& change : figures_of(before)) {
        const MethodChange* same = same_in(others, change);
        if (same == nullptr) continue;
        for (FigureChange& one : change.figures) {
            const FigureChange* is = find_by(&FigureChange::figure, one.figure, same->figures);
            if (is != nullptr) one.after = is->after;
        }
        std::erase_if(change.figures,
                      [](const FigureChange& one) { return !differs(one.before, one.after); });
        if (!change.figures.empty()) changes.push_back(std::move(change));
    }
}

bool has_same_input(const Experiment& a, const Experiment& b) {
    return a.input == b.input && a.items == b.items && a.error_unit == b.error_unit;
}

/// With fewer methods there is no interval of 95 %.
constexpr std::size_t min_methods = 6;

/// Adds the ratio of the fastest rounds of a method that is timed in both runs.
void add_ratio(std::vector<double>& ratios, const std::optional<Timing>& before,
               const std::optional<Timing>& after) {
    if (!before || !after || before->rounds.empty() || after->rounds.empty()) return;
    const double was = *std::min_element(before->rounds.begin(), before->rounds.end());
    const double is = *std::min_element(after->rounds.begin(), after->rounds.end());
    if (was > 0.0 && is > 0.0) ratios.push_back(is / was);
}

/// The measurements of a method in both runs.
struct MethodPair {
    Subject subject;
    const Measurement& before;
    const Measurement& after;
};

void add_times(ReportComparison& result, std::span<const MethodPair> pairs,
               std::optional<Subject> subject) {
    for (const bool on_all_threads : {false, true}) {
        std::vector<double> ratios;
        for (const MethodPair& pair : pairs) {
            if (subject && pair.subject != *subject) continue;
            const auto time = on_all_threads ? &Cost::all_threads : &Cost::one_thread;
            add_ratio(ratios, pair.before.cost.*time, pair.after.cost.*time);
        }
        if (ratios.size() < min_methods) continue;
        const std::size_t methods = ratios.size();
        result.times.push_back(
            {subject, on_all_threads, methods, median_interval(std::move(ratios))});
    }
}

/// Smaller differences come from memory pages and from the timing of threads.
constexpr double min_memory_ratio = 1.1;
constexpr double min_memory_bytes = 1e6;

void add_memory(ReportComparison& result, const std::string& experiment, const Measurement& was,
                const Measurement& is) {
    if (!was.cost.peak_bytes || !is.cost.peak_bytes) return;
    ++result.with_memory;
    const auto before = static_cast<double>(*was.cost.peak_bytes);
    const auto after = static_cast<double>(*is.cost.peak_bytes);
    const auto [less, more] = std::minmax(before, after);
    if (more - less < min_memory_bytes || more < min_memory_ratio * less) return;
    result.memory.push_back({experiment, "", was.method, {{"memory", before, after}}});
}

}  // namespace

ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after) {
    ReportComparison result;
    std::vector<MethodPair> pairs;
    std::set<Subject> subjects;
    for (const Experiment& new_one : after) {
        const Experiment* old_one = find_by(&Experiment::id, new_one.id, before);
        if (old_one == nullptr || has_same_input(*old_one, new_one))
            add_missing(result.added, new_one, old_one);
    }
    for (const Experiment& old_one : before) {
        const Experiment* new_one = find_by(&Experiment::id, old_one.id, after);
        if (new_one != nullptr && !has_same_input(old_one, *new_one)) {
            result.other_input.push_back(old_one.id);
            continue;
        }
        add_missing(result.gone, old_one, new_one);
        if (new_one == nullptr) continue;
        add_changes(result.errors, old_one, *new_one);
        subjects.insert(old_one.subject);
        for (const Measurement& was : old_one.measurements) {
            const Measurement* is =
                find_by(&Measurement::method, was.method, new_one->measurements);
            if (is == nullptr) continue;
            ++result.methods;
            add_memory(result, old_one.id, was, *is);
            pairs.push_back({old_one.subject, was, *is});
        }
    }
    add_times(result, pairs, std::nullopt);
    if (subjects.size() > 1) {
        for (const Subject subject : subjects)
            add_times(result, pairs, subject);
    }
    return result;
}

}  // namespace relief::accuracy
