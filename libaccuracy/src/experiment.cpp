// SPDX-License-Identifier: Apache-2.0
// Derives figures, efficient methods and convergence orders from measured data; matches the methods
// of two runs by experiment and name, and judges their errors, times and memory.
#include "relief/accuracy/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "portable_math.h"

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
        const double x = portable::log(point.x);
        const double y = portable::log(point.error);
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

const FigureChange& ErrorChange::worst() const {
    return *std::max_element(
        figures.begin(), figures.end(),
        [](const FigureChange& a, const FigureChange& b) { return a.growth() < b.growth(); });
}

double MemoryChange::growth() const {
    if (before == 0) return after > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    return static_cast<double>(after) / static_cast<double>(before) - 1.0;
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

/// Compares positions on the x axis, which may be tiny or zero.
bool is_same_position(double a, double b) {
    return std::abs(a - b) <= relative_rounding * std::max(std::abs(a), std::abs(b));
}

void add_if_changed(ErrorChange& change, const std::string& figure, double before, double after) {
    if (differs(before, after)) change.figures.push_back({figure, before, after});
}

/// The first element whose `name` is `value`, or nullptr.
template <typename Element>
const Element* find_by(std::string Element::*name, const std::string& value,
                       const std::vector<Element>& all) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Element& one) { return one.*name == value; });
    return found == all.end() ? nullptr : &*found;
}

/// The curve of another run with the same chart and method, or nullptr.
const Curve* same_curve(const Experiment& other, const Chart& chart, const Curve& curve) {
    const Chart* same_chart = find_by(&Chart::id, chart.id, other.charts);
    return same_chart == nullptr ? nullptr
                                 : find_by(&Curve::method, curve.method, same_chart->curves);
}

const CurvePoint* find_point(const Curve& curve, double x) {
    const auto found =
        std::find_if(curve.points.begin(), curve.points.end(),
                     [&](const CurvePoint& one) { return is_same_position(one.x, x); });
    return found == curve.points.end() ? nullptr : &*found;
}

std::string position_name(const CurvePoint& point) {
    return fmt::format("at {:.4g}", point.x);
}

ErrorChange change_of(const Experiment& experiment, const Chart& chart, const Curve& before,
                      const Curve& after) {
    ErrorChange change{experiment.id, chart.id, before.method, {}};
    for (const CurvePoint& point : before.points) {
        if (const CurvePoint* same = find_point(after, point.x))
            add_if_changed(change, position_name(point), point.error, same->error);
    }
    return change;
}

/// The difference of the errors of one method; may have no figures.
ErrorChange change_of(const Experiment& experiment, const Measurement& before,
                      const Measurement& after) {
    ErrorChange change{experiment.id, "", before.method, {}};
    const ErrorStats& old_error = before.error;
    const ErrorStats& new_error = after.error;
    add_if_changed(change, "rms", old_error.rms, new_error.rms);
    add_if_changed(change, "mean", old_error.mean, new_error.mean);
    add_if_changed(change, "p99", old_error.p99, new_error.p99);
    add_if_changed(change, "max", old_error.max, new_error.max);
    add_if_changed(change, "undefined", static_cast<double>(old_error.undefined),
                   static_cast<double>(new_error.undefined));
    return change;
}

/// The curves of both experiments that differ, with the points that differ.
std::vector<ErrorChange> curve_changes(const Experiment& before, const Experiment& after) {
    std::vector<ErrorChange> changes;
    for (const Chart& chart : before.charts) {
        for (const Curve& curve : chart.curves) {
            const Curve* same = same_curve(after, chart, curve);
            if (same == nullptr) continue;
            ErrorChange change = change_of(before, chart, curve, *same);
            if (!change.figures.empty()) changes.push_back(std::move(change));
        }
    }
    return changes;
}

/// Curves without a partner in the other run: "EXPERIMENT, chart ID: METHOD", or with " at X" for a
/// single point.
std::vector<std::string> curves_missing_from(const Experiment& other,
                                             const Experiment& experiment) {
    std::vector<std::string> names;
    for (const Chart& chart : experiment.charts) {
        for (const Curve& curve : chart.curves) {
            const std::string name =
                fmt::format("{}, chart {}: {}", experiment.id, chart.id, curve.method);
            const Curve* same = same_curve(other, chart, curve);
            if (same == nullptr) {
                names.push_back(name);
                continue;
            }
            for (const CurvePoint& point : curve.points) {
                if (find_point(*same, point.x) == nullptr)
                    names.push_back(name + " " + position_name(point));
            }
        }
    }
    return names;
}

/// "EXPERIMENT: METHOD" for each method that is in one run and not in the other.
std::vector<std::string> missing_from(const std::vector<Experiment>& other,
                                      const std::vector<Experiment>& all) {
    std::vector<std::string> names;
    for (const Experiment& experiment : all) {
        const Experiment* same = find_by(&Experiment::id, experiment.id, other);
        for (const Measurement& one : experiment.measurements) {
            if (same == nullptr ||
                find_by(&Measurement::method, one.method, same->measurements) == nullptr)
                names.push_back(experiment.id + ": " + one.method);
        }
    }
    return names;
}

bool has_same_input(const Experiment& a, const Experiment& b) {
    return a.input == b.input && a.items == b.items && a.error_unit == b.error_unit;
}

/// The rounds of one method in both runs.
struct TimedPair {
    std::string experiment;
    std::string method;
    bool on_all_threads = false;
    std::vector<double> before;  ///< Seconds; not empty.
    std::vector<double> after;
};

double fastest(const std::vector<double>& rounds) {
    return *std::min_element(rounds.begin(), rounds.end());
}

void add_pair(std::vector<TimedPair>& pairs, const std::string& experiment,
              const std::string& method, bool on_all_threads, const std::optional<Timing>& before,
              const std::optional<Timing>& after) {
    if (!before || !after || before->rounds.empty() || after->rounds.empty()) return;
    if (!(fastest(before->rounds) > 0.0) || !(fastest(after->rounds) > 0.0)) return;
    pairs.push_back({experiment, method, on_all_threads, before->rounds, after->rounds});
}

/// With fewer methods the interquartile range of their ratios is unknown.
constexpr std::size_t min_methods = 8;
/// The multiple of the interquartile range that is attributed to noise. In 231 comparisons of equal
/// runs of 78 methods, on two processors with 3 to 40 busy processes, 6 is the smallest whole
/// number without a false alarm.
constexpr double noise_ranges = 12.0;
/// Smaller changes are never reported: the position of code and data in memory can change a time as
/// much.
constexpr double min_resolution = 1.10;

double ratio_of(const TimedPair& pair) {
    return fastest(pair.after) / fastest(pair.before);
}

/// The ratio of the median round to the fastest round.
double relative_median(const std::vector<double>& rounds) {
    return time_statistics(rounds).median / fastest(rounds);
}

TimeVerdict verdict_of(double ratio, double resolution, const std::optional<double>& max_ratio) {
    if (ratio > resolution) return TimeVerdict::slower;
    if (ratio < 1.0 / resolution) return TimeVerdict::faster;
    return max_ratio && resolution > *max_ratio ? TimeVerdict::cannot_tell : TimeVerdict::unchanged;
}

/// The factor that is attributed to noise, from the scatter of the ratios of all methods.
double noise_factor(const CommonChange& common) {
    if (!common.is_judged) return std::numeric_limits<double>::infinity();
    return 1.0 + noise_ranges * (common.upper_quartile / common.lower_quartile - 1.0);
}

/// The change that these methods share. All are timed on one thread, or all on all threads.
CommonChange common_change(std::span<const TimedPair> pairs, bool same_machine,
                           const std::optional<double>& max_ratio) {
    CommonChange common;
    common.methods = pairs.size();
    if (pairs.empty()) return common;
    std::vector<double> ratios;
    for (const TimedPair& pair : pairs)
        ratios.push_back(ratio_of(pair));
    std::sort(ratios.begin(), ratios.end());
    common.ratio = quantile(ratios, 0.5);
    common.lower_quartile = quantile(ratios, 0.25);
    common.upper_quartile = quantile(ratios, 0.75);
    common.is_judged = pairs.size() >= min_methods;
    common.resolution = std::max(min_resolution, noise_factor(common));
    if (same_machine && common.is_judged)
        common.verdict = verdict_of(common.ratio, common.resolution, max_ratio);
    return common;
}

/// The smaller change of the two ratios, or 1 if one is slower and the other faster.
double counted_ratio(double measured, double relative, bool same_machine) {
    if (!same_machine) return relative;
    if (measured > 1.0 && relative > 1.0) return std::min(measured, relative);
    if (measured < 1.0 && relative < 1.0) return std::max(measured, relative);
    return 1.0;
}

TimeChange judged_time(const TimedPair& pair, const CommonChange& common, bool same_machine,
                       const std::optional<double>& max_ratio) {
    TimeChange change;
    change.experiment = pair.experiment;
    change.method = pair.method;
    change.on_all_threads = pair.on_all_threads;
    change.before = fastest(pair.before);
    change.after = fastest(pair.after);
    change.ratio = ratio_of(pair);
    change.relative = change.ratio / common.ratio;
    change.counted = counted_ratio(change.ratio, change.relative, same_machine);
    change.resolution = std::max(
        min_resolution,
        noise_factor(common) * std::max(relative_median(pair.before), relative_median(pair.after)));
    change.verdict = verdict_of(change.counted, change.resolution, max_ratio);
    return change;
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
    const double more = std::max(before, after);
    const double less = std::min(before, after);
    if (more - less < min_memory_bytes || more < min_memory_ratio * less) return;
    result.memory.push_back({experiment, was.method, *was.cost.peak_bytes, *is.cost.peak_bytes});
}

/// The pairs that are timed on one thread, or those on all threads.
std::vector<TimedPair> of_kind(const std::vector<TimedPair>& pairs, bool on_all_threads) {
    std::vector<TimedPair> chosen;
    std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(chosen),
                 [&](const TimedPair& one) { return one.on_all_threads == on_all_threads; });
    return chosen;
}

}  // namespace

ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after, bool same_machine,
                                 const std::optional<double>& max_ratio) {
    ReportComparison result;
    result.gone = missing_from(after, before);
    result.added = missing_from(before, after);
    std::vector<TimedPair> pairs;
    for (const Experiment& old_one : before) {
        const Experiment* new_one = find_by(&Experiment::id, old_one.id, after);
        if (new_one == nullptr) continue;
        if (!has_same_input(old_one, *new_one)) {
            result.other_input.push_back(old_one.id);
            continue;
        }
        for (const Measurement& was : old_one.measurements) {
            const Measurement* is =
                find_by(&Measurement::method, was.method, new_one->measurements);
            if (is == nullptr) continue;
            ++result.methods;
            ErrorChange change = change_of(old_one, was, *is);
            if (!change.figures.empty()) result.errors.push_back(std::move(change));
            add_memory(result, old_one.id, was, *is);
            add_pair(pairs, old_one.id, was.method, false, was.cost.one_thread,
                     is->cost.one_thread);
            add_pair(pairs, old_one.id, was.method, true, was.cost.all_threads,
                     is->cost.all_threads);
        }
        for (ErrorChange& change : curve_changes(old_one, *new_one))
            result.errors.push_back(std::move(change));
        for (std::string& name : curves_missing_from(*new_one, old_one))
            result.gone.push_back(std::move(name));
        for (std::string& name : curves_missing_from(old_one, *new_one))
            result.added.push_back(std::move(name));
    }
    for (const bool on_all_threads : {false, true}) {
        const std::vector<TimedPair> kind = of_kind(pairs, on_all_threads);
        CommonChange& common = on_all_threads ? result.all_threads : result.one_thread;
        common = common_change(kind, same_machine, max_ratio);
        for (const TimedPair& pair : kind)
            result.times.push_back(judged_time(pair, common, same_machine, max_ratio));
    }
    return result;
}

}  // namespace relief
