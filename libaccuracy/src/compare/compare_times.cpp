// SPDX-License-Identifier: Apache-2.0
// Ratios of medians, and how far two runs of one program differ. In logarithms, where slower and
// faster by the same factor are equally far from 0.
// Tests: tests/accuracy/compare_times_test.cpp, compare_reports_test.cpp.
#include "compare/compare_times.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "relief/mesh/timing.h"

namespace relief {
namespace {

/// Smaller changes are of no interest, however certain.
constexpr double least_ratio = 1.03;
/// With fewer methods, the median ratio and the scatter around it cannot be estimated.
constexpr std::size_t fewest_methods = 8;
/// A run is cut into so many parts, in the order in which rounds were taken: as many as passes are
/// made by default.
constexpr std::size_t parts_of_a_run = 3;
/// Probability that a comparison of equal runs reports any change of a single method.
constexpr double false_alarm = 0.05;
/// Student's t for 99.9 % and 2 * (parts_of_a_run - 1) degrees of freedom, for all methods
/// together: so wide because neighboring parts of a run are more alike than two runs.
constexpr double common_deviations = 8.610;
/// The variance of the median of three normal values, where that of each is 1: 1 - sqrt(3)
/// / pi. A run of three parts is as slow as the one in the middle.
constexpr double variance_of_median = 0.4487;
/// Makes a median absolute deviation the standard deviation of a normal distribution.
constexpr double normal_by_median = 1.4826;

double median_of(std::vector<double> values) {
    return spread_of(std::move(values)).median;
}

double log_ratio(const TimedPair& pair) {
    return std::log(median_of(pair.after) / median_of(pair.before));
}

/// How large the logarithm of a ratio must be for the middle 80 % of the rounds of both runs not to
/// overlap. Rounds that other programs interrupt now and then have two typical lengths, between
/// which a median jumps; a standard error does not show that.
double overlap_of_rounds(const TimedPair& pair) {
    const Spread before = spread_of(pair.before);
    const Spread after = spread_of(pair.after);
    return std::max(std::log(before.p90 / before.median * after.median / after.p10),
                    std::log(before.median / before.p10 * after.p90 / after.median));
}

/// The number of deviations that a single method's ratio must exceed, so that none of so many
/// equal methods is reported with probability 1 - false_alarm: a normal value lies beyond k
/// deviations with a probability of less than exp(-k^2 / 2).
double deviations_for(std::size_t methods) {
    return std::sqrt(2.0 * std::log(static_cast<double>(methods) / false_alarm));
}

/// How far from the median ratio equal methods lie at most, with probability 1 - false_alarm: as
/// for a normal distribution with their median distance, or, where more are farther than that
/// allows, with exponential tails. A tenth of the methods, or two, may have changed and have no say
/// in it.
double reach_of_chance(std::vector<double> distances) {
    std::sort(distances.begin(), distances.end());
    const std::size_t count = distances.size();
    const std::size_t farther = std::max<std::size_t>(count / 10, 2);
    const double median = median_of(distances);
    if (count <= 2 * farther) return deviations_for(count) * normal_by_median * median;
    const auto methods = static_cast<double>(count);
    const double decay = (distances[count - 1 - farther] - median) /
                         std::log(0.5 * methods / static_cast<double>(farther));
    return std::max(deviations_for(count) * normal_by_median * median,
                    median + decay * std::log(0.5 * methods / false_alarm));
}

/// Returns the logarithm of the median time ratio of all methods for each part of a run.
std::vector<double> levels_of_parts(const std::vector<TimedPair>& pairs,
                                    std::vector<double> TimedPair::*run) {
    std::array<std::vector<double>, parts_of_a_run> logs;
    for (const TimedPair& pair : pairs) {
        const std::vector<double>& rounds = pair.*run;
        const double whole = median_of(rounds);
        if (rounds.size() < parts_of_a_run) continue;
        auto begin = rounds.begin();
        for (std::size_t part = 0; part < parts_of_a_run; ++part) {
            // As passes share rounds out: the first ones take one more.
            const std::size_t more = part < rounds.size() % parts_of_a_run ? 1 : 0;
            const auto end =
                begin + static_cast<std::ptrdiff_t>(rounds.size() / parts_of_a_run + more);
            logs.at(part).push_back(std::log(median_of({begin, end}) / whole));
            begin = end;
        }
    }
    std::vector<double> levels;
    for (const std::vector<double>& part : logs) {
        if (!part.empty()) levels.push_back(median_of(part));
    }
    return levels;
}

/// The standard error of the common ratio by how much the speed of the machine varied within the
/// runs: parts of one run differ by the machine alone.
double drift_of(const std::vector<TimedPair>& pairs) {
    double squares = 0.0;
    for (const auto run : {&TimedPair::before, &TimedPair::after}) {
        const std::vector<double> levels = levels_of_parts(pairs, run);
        double mean = 0.0;
        for (const double level : levels)
            mean += level / static_cast<double>(levels.size());
        for (const double level : levels)
            squares += (level - mean) * (level - mean);
    }
    constexpr double parts = parts_of_a_run;
    const double variance = squares / (2.0 * (parts - 1.0));
    return std::sqrt(variance * 2.0 * variance_of_median);
}

Interval interval_around(double log_value, double half_width) {
    return {std::exp(log_value), std::exp(log_value - half_width),
            std::exp(log_value + half_width)};
}

TimeVerdict verdict_of(double ratio, double resolution, const std::optional<double>& max_ratio) {
    if (ratio > resolution) return TimeVerdict::slower;
    if (ratio < 1.0 / resolution) return TimeVerdict::faster;
    return max_ratio && resolution > *max_ratio ? TimeVerdict::cannot_tell : TimeVerdict::unchanged;
}

/// The lesser of what was measured and what is relative to all methods, where both agree in sign.
double counted_ratio(double measured, double relative, bool same_machine) {
    if (!same_machine) return relative;
    if (measured > 1.0 && relative > 1.0) return std::min(measured, relative);
    if (measured < 1.0 && relative < 1.0) return std::max(measured, relative);
    return 1.0;
}

}  // namespace

CommonChange common_change(const std::vector<TimedPair>& pairs, bool same_machine,
                           const std::optional<double>& max_ratio) {
    CommonChange common;
    common.methods = pairs.size();
    if (pairs.empty()) return common;
    std::vector<double> logs;
    for (const TimedPair& pair : pairs)
        logs.push_back(log_ratio(pair));
    const double middle = median_of(logs);
    common.is_judged = pairs.size() >= fewest_methods;
    std::vector<double> distances;
    for (const double one : logs)
        distances.push_back(std::abs(one - middle));
    common.scatter = normal_by_median * median_of(distances);
    common.reach = reach_of_chance(distances);
    common.drift = drift_of(pairs);
    // The median of many ratios is known as well as one of them is, divided by the square root.
    const double own = 1.2533 * common.scatter / std::sqrt(static_cast<double>(pairs.size()));
    const double half_width = common_deviations * std::hypot(common.drift, own);
    common.ratio = interval_around(middle, half_width);
    common.resolution = std::max(least_ratio, std::exp(half_width));
    if (same_machine && common.is_judged)
        common.verdict = verdict_of(common.ratio.value, common.resolution, max_ratio);
    return common;
}

std::vector<TimeChange> judged_times(const std::vector<TimedPair>& pairs,
                                     const CommonChange& common, bool same_machine,
                                     const std::optional<double>& max_ratio) {
    std::vector<TimeChange> changes;
    // Few methods do not show what they have in common: the machine's drift is in each of them.
    const double of_all =
        common.is_judged ? common.reach : deviations_for(pairs.size()) * common.drift;
    const double shift = common.is_judged ? common.ratio.value : 1.0;
    for (const TimedPair& pair : pairs) {
        const double half_width = std::max(of_all, overlap_of_rounds(pair));
        TimeChange change;
        change.experiment = pair.experiment;
        change.method = pair.method;
        change.on_all_threads = pair.on_all_threads;
        change.before = median_of(pair.before);
        change.after = median_of(pair.after);
        change.ratio = interval_around(log_ratio(pair), half_width);
        change.relative = change.ratio.value / shift;
        change.counted = counted_ratio(change.ratio.value, change.relative, same_machine);
        change.resolution = std::max(least_ratio, std::exp(half_width));
        change.verdict = verdict_of(change.counted, change.resolution, max_ratio);
        changes.push_back(std::move(change));
    }
    return changes;
}

}  // namespace relief
