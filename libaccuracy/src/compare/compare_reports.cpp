// SPDX-License-Identifier: Apache-2.0
// Two runs, matched by experiment and method. Tests: tests/accuracy/compare_reports_test.cpp.
#include "relief/accuracy/compare_reports.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "compare/compare_errors.h"

namespace relief {
namespace {

const Experiment* find(const std::vector<Experiment>& all, const std::string& id) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Experiment& one) { return one.id == id; });
    return found == all.end() ? nullptr : &*found;
}

const Measurement* find(const Experiment* experiment, const std::string& method) {
    if (experiment == nullptr) return nullptr;
    const auto& all = experiment->measurements;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Measurement& one) { return one.method == method; });
    return found == all.end() ? nullptr : &*found;
}

/// "EXPERIMENT: METHOD" for what is in one run and not in the other.
std::vector<std::string> missing_from(const std::vector<Experiment>& other,
                                      const std::vector<Experiment>& all) {
    std::vector<std::string> names;
    for (const Experiment& experiment : all) {
        const Experiment* same = find(other, experiment.id);
        for (const Measurement& one : experiment.measurements) {
            if (find(same, one.method) == nullptr)
                names.push_back(experiment.id + ": " + one.method);
        }
    }
    return names;
}

void append(std::vector<std::string>& all, std::vector<std::string> more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
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

/// With fewer methods the interquartile range of their ratios is not known.
constexpr std::size_t min_methods = 8;
/// The multiple of the interquartile range that chance is allowed. In 231 comparisons of equal runs
/// of 78 methods, on two processors with 3 to 40 busy processes, 6 is the smallest whole number
/// without a false alarm.
constexpr double ranges_of_chance = 12.0;
/// Smaller changes are never reported: the place of code and data in memory can change a time as
/// much.
constexpr double min_resolution = 1.10;

/// \param sorted  not empty  \param share  0 to 1
double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

double ratio_of(const TimedPair& pair) {
    return fastest(pair.after) / fastest(pair.before);
}

/// By which factor the median round is slower than the fastest one.
double unsteadiness_of(const std::vector<double>& rounds) {
    return spread_of(rounds).median / fastest(rounds);
}

TimeVerdict verdict_of(double ratio, double resolution, const std::optional<double>& max_ratio) {
    if (ratio > resolution) return TimeVerdict::slower;
    if (ratio < 1.0 / resolution) return TimeVerdict::faster;
    return max_ratio && resolution > *max_ratio ? TimeVerdict::cannot_tell : TimeVerdict::unchanged;
}

/// The factor that chance is allowed by how far the ratios of all methods scatter.
double chance_of(const CommonChange& common) {
    if (!common.is_judged) return std::numeric_limits<double>::infinity();
    return 1.0 + ranges_of_chance * (common.upper_quartile / common.lower_quartile - 1.0);
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
    common.resolution = std::max(min_resolution, chance_of(common));
    if (same_machine && common.is_judged)
        common.verdict = verdict_of(common.ratio, common.resolution, max_ratio);
    return common;
}

/// The smaller change of the two ratios, or none if one is slower and the other faster.
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
        chance_of(common) * std::max(unsteadiness_of(pair.before), unsteadiness_of(pair.after)));
    change.verdict = verdict_of(change.counted, change.resolution, max_ratio);
    return change;
}

/// Less is pages, and how threads happen to meet.
constexpr double least_memory_ratio = 1.1;
constexpr double least_memory_bytes = 1e6;

void add_memory(ReportComparison& result, const std::string& experiment, const Measurement& was,
                const Measurement& is) {
    if (!was.cost.peak_bytes || !is.cost.peak_bytes) return;
    ++result.with_memory;
    const auto before = static_cast<double>(*was.cost.peak_bytes);
    const auto after = static_cast<double>(*is.cost.peak_bytes);
    const double more = std::max(before, after);
    const double less = std::min(before, after);
    if (more - less < least_memory_bytes || more < least_memory_ratio * less) return;
    result.memory.push_back({experiment, was.method, *was.cost.peak_bytes, *is.cost.peak_bytes});
}

/// Those of `pairs` on one thread, or on all.
std::vector<TimedPair> of_kind(const std::vector<TimedPair>& pairs, bool on_all_threads) {
    std::vector<TimedPair> chosen;
    std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(chosen),
                 [&](const TimedPair& one) { return one.on_all_threads == on_all_threads; });
    return chosen;
}

}  // namespace

double MemoryChange::growth() const {
    if (before == 0) return after > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    return static_cast<double>(after) / static_cast<double>(before) - 1.0;
}

ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after, bool same_machine,
                                 const std::optional<double>& max_ratio) {
    ReportComparison result;
    result.gone = missing_from(after, before);
    result.added = missing_from(before, after);
    std::vector<TimedPair> pairs;
    for (const Experiment& old_one : before) {
        const Experiment* new_one = find(after, old_one.id);
        if (new_one == nullptr) continue;
        if (!has_same_input(old_one, *new_one)) {
            result.other_input.push_back(old_one.id);
            continue;
        }
        for (const Measurement& was : old_one.measurements) {
            const Measurement* is = find(new_one, was.method);
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
        append(result.gone, curves_missing_from(*new_one, old_one));
        append(result.added, curves_missing_from(old_one, *new_one));
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
