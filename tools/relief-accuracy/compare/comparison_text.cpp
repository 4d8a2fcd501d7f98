// SPDX-License-Identifier: Apache-2.0
// Words for changes. Tests: tests/tools/accuracy_compare_test.cpp.
#include "compare/comparison_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/text.h"
#include "relief/mesh/timing.h"
#include "report_table.h"

namespace relief::tools {
namespace {

double percent(double ratio) {
    return 100.0 * (ratio - 1.0);
}

/// So many lines of a kind are printed, the greatest changes first; the rest is counted.
constexpr std::size_t most_lines = 20;
/// And so many figures of a line: a curve may have dozens.
constexpr std::size_t most_figures = 5;

std::string threads_of(bool on_all_threads) {
    return on_all_threads ? "all threads" : "one thread";
}

std::string change_name(const TimeChange& change) {
    return fmt::format("{}: {}", change.experiment, change.method);
}

std::string change_name(const ErrorChange& change) {
    if (change.chart.empty()) return fmt::format("{}: {}", change.experiment, change.method);
    return fmt::format("{}, chart {}: {}", change.experiment, change.chart, change.method);
}

std::string result_text(double value) {
    return std::isnan(value) ? "no result" : fmt::format("{:.4g}", value);
}

/// "storage/frames: angle16: 1.21 times, 550 µs then 666 µs on one thread"
std::string line_of(const TimeChange& change) {
    std::string text =
        fmt::format("{}: {:.2f} times, {} then {} on {}", change_name(change), change.ratio,
                    seconds_in_words(change.before), seconds_in_words(change.after),
                    threads_of(change.on_all_threads));
    if (std::abs(std::log(change.relative / change.ratio)) > 0.01)
        text += fmt::format("; {:.2f} times relative to all", change.relative);
    return text;
}

/// "bump/waves: sobel3: max 0.3 then 0.4, rms 0.1 then 0.11": of many, those that grew most.
std::string line_of(const ErrorChange& change) {
    std::vector<FigureChange> worst = change.figures;
    std::stable_sort(worst.begin(), worst.end(), [](const FigureChange& a, const FigureChange& b) {
        return a.growth() > b.growth();
    });
    const std::size_t more = worst.size() - std::min(worst.size(), most_figures);
    worst.resize(worst.size() - more);
    std::vector<std::string> figures;
    for (const FigureChange& one : worst)
        figures.push_back(fmt::format("{} {} then {}", one.figure, result_text(one.before),
                                      result_text(one.after)));
    return fmt::format("{}: {}{}", change_name(change), fmt::join(figures, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
}

/// "normals/large: max, float64: 12 MB then 24 MB"
std::string line_of(const MemoryChange& change) {
    return fmt::format("{}: {}: {} then {}", change.experiment, change.method,
                       byte_size(change.before), byte_size(change.after));
}

/// At most most_lines, and how many more there are.
void print_some(const std::string& label, std::vector<std::string> lines) {
    const std::size_t more = lines.size() - std::min(lines.size(), most_lines);
    lines.resize(lines.size() - more);
    if (more > 0) lines.push_back(fmt::format("and {} more (--json lists all)", more));
    print_entry(label, lines);
}

std::vector<TimeChange> times_that_are(const ReportComparison& found, TimeVerdict verdict) {
    std::vector<TimeChange> chosen;
    for (const TimeChange& change : found.times) {
        if (change.verdict == verdict) chosen.push_back(change);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](const TimeChange& a, const TimeChange& b) {
        return std::abs(std::log(a.counted)) > std::abs(std::log(b.counted));
    });
    return chosen;
}

/// Those that became worse in some figure, or those that did in none; the worst first.
std::vector<ErrorChange> errors_that(const ReportComparison& found, bool grew) {
    std::vector<ErrorChange> chosen;
    for (const ErrorChange& change : found.errors) {
        if ((change.worst().growth() > 0.0) == grew) chosen.push_back(change);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](const ErrorChange& a, const ErrorChange& b) {
        return a.worst().growth() > b.worst().growth();
    });
    return chosen;
}

/// Those that hold more than before, or those that hold less; the greatest change first.
std::vector<MemoryChange> memory_that(const ReportComparison& found, bool grew) {
    std::vector<MemoryChange> chosen;
    for (const MemoryChange& change : found.memory) {
        if ((change.growth() > 0.0) == grew) chosen.push_back(change);
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [&](const MemoryChange& a, const MemoryChange& b) {
                         return grew ? a.growth() > b.growth() : a.growth() < b.growth();
                     });
    return chosen;
}

template <typename Change>
std::vector<std::string> lines_of(const std::vector<Change>& changes) {
    std::vector<std::string> lines;
    for (const Change& change : changes)
        lines.push_back(line_of(change));
    return lines;
}

/// The median and the largest of what must be exceeded for a change of a single method to be seen.
std::string resolution_words(const ReportComparison& found, bool on_all_threads) {
    std::vector<double> all;
    for (const TimeChange& change : found.times) {
        if (change.on_all_threads == on_all_threads) all.push_back(change.resolution);
    }
    const double largest = *std::max_element(all.begin(), all.end());
    return fmt::format(
        "a change of one method is seen from {:.0f} % on (the median method) to "
        "{:.0f} % (the least steady one)",
        percent(spread_of(std::move(all)).median), percent(largest));
}

/// "1.02 times as long on one thread (median of 40 methods; half of them 1.00 to 1.04)", and the
/// smallest change that is seen.
std::string line_of(const ReportComparison& found, bool on_all_threads) {
    const CommonChange& common = on_all_threads ? found.all_threads : found.one_thread;
    return fmt::format(
        "{:.2f} times as long on {} (median of {}; half of them {:.2f} to {:.2f}); {}",
        common.ratio, threads_of(on_all_threads), counted(common.methods, "method"),
        common.lower_quartile, common.upper_quartile,
        common.is_judged ? resolution_words(found, on_all_threads)
                         : "too few methods to tell a change from chance");
}

std::string described(const AccuracyReport& report) {
    return fmt::format("relief {}, {}{}{}", report.relief, report.command,
                       report.machine.processor.empty() ? "" : "; " + report.machine.processor,
                       report.settings.timed ? "" : "; no times");
}

bool have_other_opengl(const ComparedReports& compared) {
    const auto& before = compared.before.machine.opengl;
    const auto& after = compared.after.machine.opengl;
    return before && after && *before != *after;
}

void print_times(const ReportComparison& found) {
    std::vector<std::string> common;
    if (found.one_thread.methods > 0) common.push_back(line_of(found, false));
    if (found.all_threads.methods > 0) common.push_back(line_of(found, true));
    if (common.empty()) common.emplace_back("none in common");
    print_entry("times", common);
    print_some("slower", lines_of(times_that_are(found, TimeVerdict::slower)));
    print_some("faster", lines_of(times_that_are(found, TimeVerdict::faster)));
}

void print_memory(const ReportComparison& found) {
    if (found.with_memory == 0) return;
    if (found.memory.empty()) {
        print_entry("memory", fmt::format("the same within a tenth or a megabyte, of {}",
                                          counted(found.with_memory, "method")));
    }
    print_some("more", lines_of(memory_that(found, true)));
    print_some("less", lines_of(memory_that(found, false)));
    if (!found.memory.empty()) print_entry("", "memory at the most");
}

/// What can no longer be judged: a bound is not kept by leaving methods out.
void add_gone(std::vector<std::string>& lines, const ReportComparison& found) {
    for (const std::string& name : found.gone)
        lines.push_back(name + ": is gone");
}

/// Methods that are slower beyond the bound.
void add_slower(std::vector<std::string>& lines, const ReportComparison& found, double bound) {
    for (const TimeChange& change : times_that_are(found, TimeVerdict::slower)) {
        if (percent(change.counted) <= bound) continue;
        lines.push_back(fmt::format("{}: {:.1f} % slower on {} (at most {} %)", change_name(change),
                                    percent(change.counted), threads_of(change.on_all_threads),
                                    bound));
    }
}

/// Methods whose times cannot show whether the bound is kept: the least steady one, and how many.
void add_unresolved(std::vector<std::string>& lines, const ReportComparison& found, double bound) {
    std::vector<TimeChange> unresolved = times_that_are(found, TimeVerdict::cannot_tell);
    if (unresolved.empty()) return;
    const TimeChange& worst = *std::max_element(
        unresolved.begin(), unresolved.end(),
        [](const TimeChange& a, const TimeChange& b) { return a.resolution < b.resolution; });
    const std::string reason =
        std::isinf(worst.resolution)
            ? fmt::format(
                  "the reports have too few methods in common on {} (measure more "
                  "subjects)",
                  threads_of(worst.on_all_threads))
            : fmt::format(
                  "of {} on {} only changes beyond {:.0f} % are seen (measure both on a "
                  "quieter machine, or with more --repeats)",
                  change_name(worst), threads_of(worst.on_all_threads), percent(worst.resolution));
    lines.push_back(fmt::format("cannot tell whether {} of {} times kept within {} %: {}",
                                unresolved.size(), found.times.size(), bound, reason));
}

/// On one machine it also counts if all methods became slower together.
void add_common(std::vector<std::string>& lines, const CommonChange& common, bool on_all_threads,
                double bound) {
    if (common.verdict == TimeVerdict::slower && percent(common.ratio) > bound) {
        lines.push_back(fmt::format("all methods together: {:.1f} % slower on {} (at most {} %)",
                                    percent(common.ratio), threads_of(on_all_threads), bound));
    }
    if (common.verdict == TimeVerdict::cannot_tell) {
        lines.push_back(fmt::format(
            "all methods together: cannot tell whether they kept within {} % on {}: the ratios of "
            "the methods scatter (only changes beyond {:.0f} % are seen)",
            bound, threads_of(on_all_threads), percent(common.resolution)));
    }
}

}  // namespace

std::string difference_of(const AccuracyReport& before, const AccuracyReport& after) {
    std::string words = difference_of(before.machine, after.machine);
    if (before.settings.threads != after.settings.threads) {
        words += fmt::format("{}threads: {}, then {}", words.empty() ? "" : "; ",
                             before.settings.threads, after.settings.threads);
    }
    return words;
}

bool may_compare_times(const AccuracyReport& before, const AccuracyReport& after) {
    return may_compare_times(before.machine, after.machine) &&
           before.settings.threads == after.settings.threads;
}

void print_text(const ComparedReports& compared) {
    const ReportComparison& found = compared.found;
    print_entry("old", described(compared.before));
    print_entry("new", described(compared.after));
    const std::string difference = difference_of(compared.before, compared.after);
    if (!difference.empty()) {
        print_entry("machine", difference);
        if (!compared.same_machine)
            print_entry("", "times are judged relative to the median of all methods only");
        if (have_other_opengl(compared))
            print_entry("",
                        "pictures drawn by OpenGL may differ in their last bits for that alone");
    }
    print_entry("methods", fmt::format("{} in both", found.methods));
    print_some("gone", found.gone);
    print_some("added", found.added);
    print_some("not on", found.other_input);
    if (!found.other_input.empty()) print_entry("", "the same input, and not compared");
    print_times(found);
    print_memory(found);
    const auto worse = errors_that(found, true);
    const auto better = errors_that(found, false);
    if (worse.empty() && better.empty()) print_entry("errors", "all the same");
    print_some("worse", lines_of(worse));
    print_some("better", lines_of(better));
}

std::vector<std::string> beyond(const ComparedReports& compared, const ComparisonBounds& bounds) {
    std::vector<std::string> lines;
    if (bounds.max_slower) {
        add_common(lines, compared.found.one_thread, false, *bounds.max_slower);
        add_common(lines, compared.found.all_threads, true, *bounds.max_slower);
        add_slower(lines, compared.found, *bounds.max_slower);
        add_unresolved(lines, compared.found, *bounds.max_slower);
    }
    if (bounds.max_error_growth) {
        for (const ErrorChange& change : errors_that(compared.found, true)) {
            const FigureChange& worst = change.worst();
            if (100.0 * worst.growth() <= *bounds.max_error_growth) continue;
            lines.push_back(fmt::format(
                "{}: {} {} then {} (at most {} % more)", change_name(change), worst.figure,
                result_text(worst.before), result_text(worst.after), *bounds.max_error_growth));
        }
    }
    if (bounds.max_memory_growth) {
        for (const MemoryChange& change : memory_that(compared.found, true)) {
            if (100.0 * change.growth() <= *bounds.max_memory_growth) continue;
            lines.push_back(
                fmt::format("{} (at most {} % more)", line_of(change), *bounds.max_memory_growth));
        }
    }
    if (bounds.max_slower || bounds.max_error_growth || bounds.max_memory_growth)
        add_gone(lines, compared.found);
    return lines;
}

}  // namespace relief::tools
