// SPDX-License-Identifier: Apache-2.0
// Times against times: what is more than chance, and more than the machine.
// Tests: tests/accuracy/compare_reports_test.cpp.
#include "compare/compare_times.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "relief/accuracy/two_samples.h"
#include "relief/mesh/timing.h"

namespace relief {
namespace {

/// Of all changes that are told, so many may be chance.
constexpr double false_discovery_rate = 0.05;
/// Less is of no interest, however certain.
constexpr double least_ratio = 1.03;
/// Of fewer methods neither the middle nor the scatter is known.
constexpr std::size_t fewest_methods = 8;
/// A ratio counts beyond so many deviations of the others.
constexpr double deviations = 3.0;

double middle_of(std::vector<double> values) {
    return spread_of(std::move(values)).median;
}

double log_ratio(const TimedPair& pair) {
    return std::log(middle_of(pair.after) / middle_of(pair.before));
}

/// The interval of the middle of all logarithms, resampled by experiment, as a ratio.
Interval middle_ratio(const std::map<std::string, std::vector<double>>& logs_by_experiment) {
    constexpr std::size_t resamples = 1000;
    std::vector<const std::vector<double>*> experiments;
    std::vector<double> all;
    for (const auto& [name, logs] : logs_by_experiment) {
        experiments.push_back(&logs);
        all.insert(all.end(), logs.begin(), logs.end());
    }
    std::mt19937_64 random(20261122);
    std::vector<double> middles;
    for (std::size_t i = 0; i < resamples; ++i) {
        std::vector<double> drawn;
        for (std::size_t k = 0; k < experiments.size(); ++k) {
            const std::vector<double>& one = *experiments[random() % experiments.size()];
            drawn.insert(drawn.end(), one.begin(), one.end());
        }
        middles.push_back(middle_of(std::move(drawn)));
    }
    std::sort(middles.begin(), middles.end());
    return {.value = std::exp(middle_of(all)),
            .low = std::exp(middles[resamples / 40]),
            .high = std::exp(middles[resamples - 1 - resamples / 40])};
}

/// The lesser of what was measured and what is relative to all, where both say the same.
double counted_ratio(double measured, double relative, bool same_machine) {
    if (!same_machine) return relative;
    if (measured > 1.0 && relative > 1.0) return std::min(measured, relative);
    if (measured < 1.0 && relative < 1.0) return std::max(measured, relative);
    return 1.0;
}

TimeChange measured_change(const TimedPair& pair, const CommonChange& common, bool same_machine) {
    TimeChange change;
    change.experiment = pair.experiment;
    change.method = pair.method;
    change.on_all_threads = pair.on_all_threads;
    change.before = middle_of(pair.before);
    change.after = middle_of(pair.after);
    change.ratio = median_ratio(pair.before, pair.after);
    change.relative = change.ratio.value / (common.is_judged ? common.ratio.value : 1.0);
    change.counted = counted_ratio(change.ratio.value, change.relative, same_machine);
    std::vector<double> scaled = pair.after;
    for (double& seconds : scaled)
        seconds *= change.counted / change.ratio.value;
    change.p = mann_whitney_p(pair.before, scaled);
    return change;
}

TimeVerdict verdict_of(const TimeChange& change, const TimedPair& pair, const CommonChange& common,
                       bool is_found, std::size_t tests) {
    if (std::abs(std::log(change.counted)) <= std::log(common.smallest))
        return TimeVerdict::unchanged;
    if (is_found) return change.counted > 1.0 ? TimeVerdict::slower : TimeVerdict::faster;
    // Had all rounds been on one side, would it have been found as the only one of so many?
    const double least = least_mann_whitney_p(pair.before.size(), pair.after.size());
    const bool had_a_chance = least <= false_discovery_rate / static_cast<double>(tests);
    const bool looks_changed = change.p <= std::max(false_discovery_rate, least);
    return looks_changed && !had_a_chance ? TimeVerdict::cannot_tell : TimeVerdict::unchanged;
}

}  // namespace

CommonChange common_change(const std::vector<TimedPair>& pairs) {
    CommonChange common;
    common.methods = pairs.size();
    common.smallest = least_ratio;
    if (pairs.empty()) return common;
    std::map<std::string, std::vector<double>> logs;
    for (const TimedPair& pair : pairs)
        logs[pair.experiment].push_back(log_ratio(pair));
    common.ratio = middle_ratio(logs);
    common.is_judged = pairs.size() >= fewest_methods;
    std::vector<double> apart;
    for (const TimedPair& pair : pairs)
        apart.push_back(std::abs(log_ratio(pair) - std::log(common.ratio.value)));
    common.scatter = 1.4826 * middle_of(apart);  // Of a normal distribution: its deviation.
    if (common.is_judged)
        common.smallest = std::max(least_ratio, std::exp(deviations * common.scatter));
    return common;
}

std::vector<TimeChange> judged_times(const std::vector<TimedPair>& pairs,
                                     const CommonChange& one_thread,
                                     const CommonChange& all_threads, bool same_machine) {
    std::vector<TimeChange> changes;
    std::vector<double> p;
    const auto common = [&](const TimedPair& pair) -> const CommonChange& {
        return pair.on_all_threads ? all_threads : one_thread;
    };
    for (const TimedPair& pair : pairs) {
        changes.push_back(measured_change(pair, common(pair), same_machine));
        p.push_back(changes.back().p);
    }
    const std::vector<bool> found = discoveries(p, false_discovery_rate);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        changes[i].verdict =
            verdict_of(changes[i], pairs[i], common(pairs[i]), found[i], pairs.size());
    }
    return changes;
}

}  // namespace relief
