// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy compare OLD NEW` reports changes of time, error and memory between two reports,
// as text or JSON, and checks them against limits. docs/accuracy-schema.md describes the JSON.
// Tests: tests/tools/accuracy_compare_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "accuracy_report.h"
#include "commands.h"
#include "common/command.h"
#include "common/options.h"
#include "common/summary.h"
#include "common/text.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {
namespace {

/// Two reports and their comparison.
struct ComparedReports {
    AccuracyReport before;
    AccuracyReport after;
    bool same_machine = true;
    ReportComparison comparison;
};

/// The largest changes without failure, in percent.
struct ComparisonLimits {
    std::optional<double> max_slower;
    std::optional<double> max_error_growth;
    std::optional<double> max_memory_growth;
};

/// Returns the differences of machines and thread counts, or an empty text.
std::string difference_of(const AccuracyReport& before, const AccuracyReport& after) {
    std::string words = difference_of(before.machine, after.machine);
    if (before.settings.threads != after.settings.threads) {
        words += fmt::format("{}threads: {}, then {}", words.empty() ? "" : "; ",
                             before.settings.threads, after.settings.threads);
    }
    return words;
}

/// Returns whether absolute times are comparable.
bool may_compare_times(const AccuracyReport& before, const AccuracyReport& after) {
    return may_compare_times(before.machine, after.machine) &&
           before.settings.threads == after.settings.threads;
}

double percent(double ratio) {
    return 100.0 * (ratio - 1.0);
}

/// The number of printed lines per kind of change. The largest changes are first.
constexpr std::size_t max_lines = 20;
/// The number of figures in a line.
constexpr std::size_t max_figures = 5;

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
    std::string text = fmt::format("{}: {:.2f} times, {} then {} on {}", change_name(change),
                                   change.ratio, format_seconds(change.before),
                                   format_seconds(change.after), threads_of(change.on_all_threads));
    if (std::abs(std::log(change.relative / change.ratio)) > 0.01)
        text += fmt::format("; {:.2f} times relative to all", change.relative);
    return text;
}

/// "bump/waves: sobel3: max 0.3 then 0.4, rms 0.1 then 0.11" with the largest growth.
std::string line_of(const ErrorChange& change) {
    std::vector<FigureChange> worst = change.figures;
    std::stable_sort(worst.begin(), worst.end(), [](const FigureChange& a, const FigureChange& b) {
        return a.growth() > b.growth();
    });
    const std::size_t more = worst.size() - std::min(worst.size(), max_figures);
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

/// Returns at most max_lines lines, and the number of others.
std::vector<std::string> some_of(std::vector<std::string> lines) {
    const std::size_t more = lines.size() - std::min(lines.size(), max_lines);
    lines.resize(lines.size() - more);
    if (more > 0) lines.push_back(fmt::format("and {} more (--json lists all)", more));
    return lines;
}

std::vector<TimeChange> times_that_are(const ReportComparison& comparison, TimeVerdict verdict) {
    std::vector<TimeChange> chosen;
    for (const TimeChange& change : comparison.times) {
        if (change.verdict == verdict) chosen.push_back(change);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](const TimeChange& a, const TimeChange& b) {
        return std::abs(std::log(a.counted)) > std::abs(std::log(b.counted));
    });
    return chosen;
}

/// Returns the changes with or without growth of some figure; the worst is first.
std::vector<ErrorChange> errors_that(const ReportComparison& comparison, bool grew) {
    std::vector<ErrorChange> chosen;
    for (const ErrorChange& change : comparison.errors) {
        if ((change.worst().growth() > 0.0) == grew) chosen.push_back(change);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](const ErrorChange& a, const ErrorChange& b) {
        return a.worst().growth() > b.worst().growth();
    });
    return chosen;
}

/// Returns the methods that use more, or less, memory; the largest change is first.
std::vector<MemoryChange> memory_that(const ReportComparison& comparison, bool grew) {
    std::vector<MemoryChange> chosen;
    for (const MemoryChange& change : comparison.memory) {
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

/// Returns the median and the maximum of the smallest detectable change of a method.
std::string resolution_text(const ReportComparison& comparison, bool on_all_threads) {
    std::vector<double> all;
    for (const TimeChange& change : comparison.times) {
        if (change.on_all_threads == on_all_threads) all.push_back(change.resolution);
    }
    const double largest = *std::max_element(all.begin(), all.end());
    return fmt::format(
        "the smallest detectable change of a method is {:.0f} % (median) to {:.0f} % (least "
        "steady)",
        percent(time_statistics(std::move(all)).median), percent(largest));
}

/// "1.02 times as long on one thread (median of 40 methods; half of them 1.00 to 1.04)", and the
/// smallest detectable change.
std::string line_of(const ReportComparison& comparison, bool on_all_threads) {
    const CommonChange& common = on_all_threads ? comparison.all_threads : comparison.one_thread;
    return fmt::format(
        "{:.2f} times as long on {} (median of {}; half of them {:.2f} to {:.2f}); {}",
        common.ratio, threads_of(on_all_threads), counted(common.methods, "method"),
        common.lower_quartile, common.upper_quartile,
        common.is_judged ? resolution_text(comparison, on_all_threads)
                         : "too few methods to detect a change");
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

/// Methods that are missing in the new report do not meet a limit.
void add_gone(std::vector<std::string>& lines, const ReportComparison& comparison) {
    for (const std::string& name : comparison.gone)
        lines.push_back(name + ": is missing");
}

/// Adds the methods that are slower than the limit.
void add_slower(std::vector<std::string>& lines, const ReportComparison& comparison, double limit) {
    for (const TimeChange& change : times_that_are(comparison, TimeVerdict::slower)) {
        if (percent(change.counted) <= limit) continue;
        lines.push_back(fmt::format("{}: {:.1f} % slower on {} (at most {} %)", change_name(change),
                                    percent(change.counted), threads_of(change.on_all_threads),
                                    limit));
    }
}

/// Adds the number of methods whose times vary too much for the limit, and the least steady one.
void add_unresolved(std::vector<std::string>& lines, const ReportComparison& comparison,
                    double limit) {
    std::vector<TimeChange> unresolved = times_that_are(comparison, TimeVerdict::cannot_tell);
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
                  "for {} on {}, only changes above {:.0f} % are detected (measure both on a "
                  "quieter machine, or with more --repeats)",
                  change_name(worst), threads_of(worst.on_all_threads), percent(worst.resolution));
    lines.push_back(fmt::format("cannot decide whether {} of {} times are within {} %: {}",
                                unresolved.size(), comparison.times.size(), limit, reason));
}

/// Adds a slowdown of all methods together, which is significant on the same machine.
void add_common(std::vector<std::string>& lines, const CommonChange& common, bool on_all_threads,
                double limit) {
    if (common.verdict == TimeVerdict::slower && percent(common.ratio) > limit) {
        lines.push_back(fmt::format("all methods together: {:.1f} % slower on {} (at most {} %)",
                                    percent(common.ratio), threads_of(on_all_threads), limit));
    }
    if (common.verdict == TimeVerdict::cannot_tell) {
        lines.push_back(
            fmt::format("all methods together: cannot decide whether they are within {} % on {}: "
                        "the ratios of the methods vary (only changes above {:.0f} % are detected)",
                        limit, threads_of(on_all_threads), percent(common.resolution)));
    }
}

/// Returns a line per change above the limits, with method, value and limit; the largest is first.
std::vector<std::string> above_limits(const ComparedReports& compared,
                                      const ComparisonLimits& limits) {
    std::vector<std::string> lines;
    if (limits.max_slower) {
        add_common(lines, compared.comparison.one_thread, false, *limits.max_slower);
        add_common(lines, compared.comparison.all_threads, true, *limits.max_slower);
        add_slower(lines, compared.comparison, *limits.max_slower);
        add_unresolved(lines, compared.comparison, *limits.max_slower);
    }
    if (limits.max_error_growth) {
        for (const ErrorChange& change : errors_that(compared.comparison, true)) {
            const FigureChange& worst = change.worst();
            if (100.0 * worst.growth() <= *limits.max_error_growth) continue;
            lines.push_back(fmt::format(
                "{}: {} {} then {} (at most {} % more)", change_name(change), worst.figure,
                result_text(worst.before), result_text(worst.after), *limits.max_error_growth));
        }
    }
    if (limits.max_memory_growth) {
        for (const MemoryChange& change : memory_that(compared.comparison, true)) {
            if (100.0 * change.growth() <= *limits.max_memory_growth) continue;
            lines.push_back(
                fmt::format("{} (at most {} % more)", line_of(change), *limits.max_memory_growth));
        }
    }
    if (limits.max_slower || limits.max_error_growth || limits.max_memory_growth)
        add_gone(lines, compared.comparison);
    return lines;
}

const char* verdict_name(TimeVerdict verdict) {
    switch (verdict) {
        case TimeVerdict::slower:
            return "slower";
        case TimeVerdict::faster:
            return "faster";
        case TimeVerdict::cannot_tell:
            return "cannot tell";
        case TimeVerdict::unchanged:
            break;
    }
    return "unchanged";
}

Json json_of(const CommonChange& common) {
    if (common.methods == 0) return {};
    return {{"methods", common.methods},
            {"ratio", common.ratio},
            {"lower_quartile", common.lower_quartile},
            {"upper_quartile", common.upper_quartile},
            {"resolution", common.resolution},  // Infinity becomes null.
            {"judged", common.is_judged},
            {"verdict", verdict_name(common.verdict)}};
}

Json json_of(const TimeChange& change) {
    return {{"experiment", change.experiment},
            {"method", change.method},
            {"threads", change.on_all_threads ? "all" : "one"},
            {"before", change.before},
            {"after", change.after},
            {"ratio", change.ratio},
            {"relative", change.relative},
            {"counted", change.counted},
            {"resolution", change.resolution},  // Infinity becomes null.
            {"verdict", verdict_name(change.verdict)}};
}

Json json_of(const ErrorChange& change) {
    Json figures = Json::array();
    for (const FigureChange& one : change.figures) {
        figures.push_back({{"figure", one.figure},
                           {"before", one.before},
                           {"after", one.after},
                           {"growth", one.growth()}});  // Infinity becomes null.
    }
    return {{"experiment", change.experiment},
            {"chart", change.chart},
            {"method", change.method},
            {"figures", figures}};
}

Json json_of(const MemoryChange& change) {
    return {{"experiment", change.experiment},
            {"method", change.method},
            {"before", change.before},
            {"after", change.after},
            {"growth", change.growth()}};  // Infinity becomes null.
}

template <typename Change>
Json array_of(const std::vector<Change>& changes) {
    return json_list(changes, [](const Change& change) { return json_of(change); });
}

void add_machines(Summary& summary, const ComparedReports& compared) {
    const std::string difference = difference_of(compared.before, compared.after);
    std::vector<std::string> lines;
    if (!difference.empty()) {
        lines.push_back(difference);
        if (!compared.same_machine)
            lines.emplace_back("times are compared only relative to the median of all methods");
        if (have_other_opengl(compared))
            lines.emplace_back("pictures drawn by OpenGL may differ slightly for this reason");
    }
    summary.add("machine", lines,
                {{"same_machine", compared.same_machine}, {"machine", difference}});
}

void add_methods(Summary& summary, const ReportComparison& comparison) {
    summary.add("methods", fmt::format("{} in both", comparison.methods),
                {{"methods", comparison.methods}});
    summary.add("missing", some_of(comparison.gone), {{"gone", comparison.gone}});
    summary.add("added", some_of(comparison.added), {{"added", comparison.added}});
    std::vector<std::string> changed = some_of(comparison.other_input);
    if (!changed.empty()) changed.emplace_back("(different input, not compared)");
    summary.add("changed", changed, {{"other_input", comparison.other_input}});
}

void add_times(Summary& summary, const ReportComparison& comparison) {
    std::vector<std::string> common;
    if (comparison.one_thread.methods > 0) common.push_back(line_of(comparison, false));
    if (comparison.all_threads.methods > 0) common.push_back(line_of(comparison, true));
    if (common.empty()) common.emplace_back("none in common");
    summary.add("times", common,
                {{"one_thread", json_of(comparison.one_thread)},
                 {"all_threads", json_of(comparison.all_threads)},
                 {"times", array_of(comparison.times)}});
    summary.add("slower", some_of(lines_of(times_that_are(comparison, TimeVerdict::slower))));
    summary.add("faster", some_of(lines_of(times_that_are(comparison, TimeVerdict::faster))));
}

void add_memory(Summary& summary, const ReportComparison& comparison) {
    const bool is_unchanged = comparison.with_memory > 0 && comparison.memory.empty();
    summary.add("memory",
                is_unchanged ? fmt::format("unchanged within 10 % or one megabyte, for {}",
                                           counted(comparison.with_memory, "method"))
                             : "",
                {{"with_memory", comparison.with_memory}, {"memory", array_of(comparison.memory)}});
    summary.add("more", some_of(lines_of(memory_that(comparison, true))));
    summary.add("less", some_of(lines_of(memory_that(comparison, false))));
    summary.add("", comparison.memory.empty() ? "" : "(peak memory)");
}

void add_errors(Summary& summary, const ReportComparison& comparison) {
    const auto worse = errors_that(comparison, true);
    const auto better = errors_that(comparison, false);
    summary.add("errors", worse.empty() && better.empty() ? "all the same" : "",
                {{"errors", array_of(comparison.errors)}});
    summary.add("worse", some_of(lines_of(worse)));
    summary.add("better", some_of(lines_of(better)));
}

Summary summary_of(const ComparedReports& compared, const ComparisonLimits& limits) {
    Summary summary;
    summary.add_tool("relief-accuracy compare");
    summary.add("old", described(compared.before), {{"old", compared.before.command}});
    summary.add("new", described(compared.after), {{"new", compared.after.command}});
    add_machines(summary, compared);
    add_methods(summary, compared.comparison);
    add_times(summary, compared.comparison);
    add_memory(summary, compared.comparison);
    add_errors(summary, compared.comparison);
    summary.add_json({{"max_slower", or_null(limits.max_slower)},
                      {"max_error_growth", or_null(limits.max_error_growth)},
                      {"max_memory_growth", or_null(limits.max_memory_growth)},
                      {"beyond", above_limits(compared, limits)}});
    return summary;
}

struct CompareOptions {
    std::filesystem::path before;
    std::filesystem::path after;
    ComparisonLimits limits;
    bool json = false;
    bool quiet = false;
};

ComparedReports compared_reports(const CompareOptions& options) {
    ComparedReports compared;
    compared.before = read_report(options.before);
    compared.after = read_report(options.after);
    compared.same_machine = may_compare_times(compared.before, compared.after);
    std::optional<double> max_ratio;
    if (options.limits.max_slower) max_ratio = 1.0 + *options.limits.max_slower / 100.0;
    compared.comparison = compare_reports(compared.before.experiments, compared.after.experiments,
                                          compared.same_machine, max_ratio);
    return compared;
}

/// Refuses limits on values that the reports do not have.
void require_common_values(const CompareOptions& options, const ComparedReports& compared) {
    const ReportComparison& comparison = compared.comparison;
    if (comparison.methods == 0) {
        throw failure(options.after,
                      fmt::format("has no method on the same input as {}", options.before.string()),
                      "run the same subjects, both with --quick or both without");
    }
    if (options.limits.max_slower && comparison.times.empty()) {
        throw failure(
            options.after,
            fmt::format("has no times in common with {}, so --max-slower cannot be checked",
                        options.before.string()),
            "run both without --no-times");
    }
    if (options.limits.max_memory_growth && comparison.with_memory == 0) {
        throw failure(options.after,
                      fmt::format("has no method in common with {} whose memory is known, so "
                                  "--max-memory-growth cannot be checked",
                                  options.before.string()),
                      "run subjects that measure it (normals, tangents, bump, storage), both "
                      "without --no-times");
    }
}

ExitCode judge(const CLI::App& app, const CompareOptions& options,
               const ComparedReports& compared) {
    const std::vector<std::string> lines = above_limits(compared, options.limits);
    if (lines.empty()) return ExitCode::done;
    std::string text = fmt::format("{}: {}", options.after.string(), lines.front());
    if (lines.size() > 1) text += fmt::format(", and {} more above limits", lines.size() - 1);
    complain(app, text);
    return ExitCode::failed;
}

ExitCode run(const CLI::App& app, const CompareOptions& options) {
    if (options.json && options.quiet) throw UsageError("--json and --quiet contradict each other");
    const ComparedReports compared = compared_reports(options);
    require_common_values(options, compared);
    const Summary summary = summary_of(compared, options.limits);
    if (options.json)
        print_json(summary.json());
    else if (!options.quiet)
        summary.print();
    return judge(app, options, compared);
}

}  // namespace

Command add_report_compare_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "compare", "Compares the times, errors and memory of two reports.");
    const auto options = std::make_shared<CompareOptions>();
    add_file(app, "OLD", options->before, "The old report: accuracy.json of an earlier run.");
    add_file(app, "NEW", options->after, "The new report: accuracy.json of a later run.");
    const Range range{0.0, std::numeric_limits<double>::max(), "percent"};
    const char* group = "Verdict";
    add_number(app, "--max-slower", "PERCENT", options->limits.max_slower, range,
               "Exit with 1 if the time of a method, or the median of all methods, increases by "
               "more than this, beyond the variation of equal runs, or if the times vary too much "
               "to decide. With any limit, a missing method also counts.")
        .group(group);
    add_number(app, "--max-error-growth", "PERCENT", options->limits.max_error_growth, range,
               "Exit with 1 if an error figure of a method, or a point of a curve, increases by "
               "more than this, or no longer has a result.")
        .group(group);
    add_number(app, "--max-memory-growth", "PERCENT", options->limits.max_memory_growth, range,
               "Exit with 1 if the memory of a method increases by more than this, and by at least "
               "10 % and one megabyte.")
        .group(group);
    add_switch(app, "--json", options->json,
               "Print one JSON object instead of text; docs/accuracy-schema.md describes it.");
    add_switch(app, "--quiet", options->quiet, "Print only errors; the exit code is the result.");
    set_examples(app, {"relief-accuracy run storage --quick --output out/old",
                       "relief-accuracy run storage --quick --output out/new",
                       "relief-accuracy compare out/old/accuracy.json out/new/accuracy.json",
                       "relief-accuracy compare out/old/accuracy.json out/new/accuracy.json "
                       "--max-error-growth 1 --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
