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

namespace relief::tools {
using namespace relief::accuracy;

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

/// The number of printed lines per kind of change. The largest changes are first.
constexpr std::size_t max_lines = 20;
/// The number of figures in a line.
constexpr std::size_t max_figures = 5;

std::string threads_of(const TimeRatio& times) {
    return times.on_all_threads ? "all threads" : "one thread";
}

std::string subject_of(const TimeRatio& times) {
    return times.subject ? std::string(enum_name(*times.subject)) : "all";
}

/// Times on all threads are not judged: a wall clock includes the time of other programs.
const char* verdict_of(const TimeRatio& times) {
    if (times.on_all_threads) return "not judged";
    return times.is_slower() ? "slower" : times.is_faster() ? "faster" : "tie";
}

/// "storage: 1.30 times as long on one thread (1.27 to 1.33, 78 methods): slower"
std::string line_of(const TimeRatio& times) {
    return fmt::format("{}: {:.2f} times as long on {} ({:.2f} to {:.2f}, {}): {}",
                       subject_of(times), times.ratio.median, threads_of(times), times.ratio.low,
                       times.ratio.high, counted(times.methods, "method"), verdict_of(times));
}

/// "rms 0.1 then 0.11", "memory 12 MB then 24 MB"
std::string text_of(const FigureChange& change) {
    const auto text = [&](double value) {
        if (change.figure == "memory") return byte_size(static_cast<std::uintmax_t>(value));
        return std::isnan(value) ? "no result" : fmt::format("{:.4g}", value);
    };
    return fmt::format("{} {} then {}", change.figure, text(change.before), text(change.after));
}

/// "bump/waves: sobel3: max 0.3 then 0.4, rms 0.1 then 0.11" with the largest growth.
std::string line_of(const MethodChange& change) {
    std::vector<FigureChange> worst = change.figures;
    std::stable_sort(worst.begin(), worst.end(), [](const FigureChange& a, const FigureChange& b) {
        return a.growth() > b.growth();
    });
    const std::size_t more = worst.size() - std::min(worst.size(), max_figures);
    worst.resize(worst.size() - more);
    std::vector<std::string> figures;
    for (const FigureChange& one : worst)
        figures.push_back(text_of(one));
    return fmt::format("{}: {}{}", change.name(), fmt::join(figures, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Returns at most max_lines lines, and the number of others.
std::vector<std::string> some_of(std::vector<std::string> lines) {
    const std::size_t more = lines.size() - std::min(lines.size(), max_lines);
    lines.resize(lines.size() - more);
    if (more > 0) lines.push_back(fmt::format("and {} more (--json lists all)", more));
    return lines;
}

/// Returns the changes with or without growth of some figure; the largest growth is first.
std::vector<MethodChange> changes_that(const std::vector<MethodChange>& changes, bool grew) {
    std::vector<MethodChange> chosen;
    for (const MethodChange& change : changes) {
        if ((change.worst().growth() > 0.0) == grew) chosen.push_back(change);
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const MethodChange& a, const MethodChange& b) {
                         return a.worst().growth() > b.worst().growth();
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

/// Adds the figures that grew by more than a limit in percent.
void add_growth(std::vector<std::string>& lines, const std::vector<MethodChange>& changes,
                const std::optional<double>& limit) {
    if (!limit) return;
    for (const MethodChange& change : changes_that(changes, true)) {
        if (100.0 * change.worst().growth() <= *limit) continue;
        lines.push_back(fmt::format("{}: {} (at most {} % more)", change.name(),
                                    text_of(change.worst()), *limit));
    }
}

/// Returns a line per change above the limits, with method, value and limit; the largest is first.
/// A missing method exceeds every limit.
std::vector<std::string> above_limits(const ReportComparison& comparison,
                                      const ComparisonLimits& limits) {
    std::vector<std::string> lines;
    if (limits.max_slower) {
        for (const TimeRatio& times : comparison.times) {
            if (!times.on_all_threads && times.is_slower(1.0 + *limits.max_slower / 100.0))
                lines.push_back(
                    fmt::format("{} (at most {} % more)", line_of(times), *limits.max_slower));
        }
    }
    add_growth(lines, comparison.errors, limits.max_error_growth);
    add_growth(lines, comparison.memory, limits.max_memory_growth);
    if (limits.max_slower || limits.max_error_growth || limits.max_memory_growth) {
        for (const std::string& name : comparison.gone)
            lines.push_back(name + ": is missing");
    }
    return lines;
}

Json comparison_json(const TimeRatio& times) {
    return {{"subject", subject_of(times)}, {"threads", times.on_all_threads ? "all" : "one"},
            {"methods", times.methods},     {"ratio", times.ratio.median},
            {"low", times.ratio.low},       {"high", times.ratio.high},
            {"verdict", verdict_of(times)}};
}

Json comparison_json(const MethodChange& change) {
    return {{"experiment", change.experiment},
            {"chart", change.chart},
            {"method", change.method},
            {"figures", json_list(change.figures, [](const FigureChange& one) {
                 return Json{{"figure", one.figure},
                             {"before", one.before},
                             {"after", one.after},
                             {"growth", one.growth()}};  // Infinity becomes null.
             })}};
}

template <typename Change>
Json array_of(const std::vector<Change>& changes) {
    return json_list(changes, [](const Change& change) { return comparison_json(change); });
}

void add_machines(Summary& summary, const ComparedReports& compared) {
    const std::string difference = difference_of(compared.before, compared.after);
    std::vector<std::string> lines;
    if (!difference.empty()) {
        lines.push_back(difference);
        if (!compared.same_machine) lines.emplace_back("the times contain this difference");
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
    std::vector<std::string> lines = lines_of(comparison.times);
    if (lines.empty()) lines.emplace_back("of fewer than 6 methods in common");
    summary.add("times", lines, {{"times", array_of(comparison.times)}});
}

void add_memory(Summary& summary, const ReportComparison& comparison) {
    const bool is_unchanged = comparison.with_memory > 0 && comparison.memory.empty();
    summary.add("memory",
                is_unchanged ? fmt::format("unchanged within 10 % or one megabyte, for {}",
                                           counted(comparison.with_memory, "method"))
                             : "",
                {{"with_memory", comparison.with_memory}, {"memory", array_of(comparison.memory)}});
    summary.add("more", some_of(lines_of(changes_that(comparison.memory, true))));
    summary.add("less", some_of(lines_of(changes_that(comparison.memory, false))));
}

void add_errors(Summary& summary, const ReportComparison& comparison) {
    summary.add("errors", comparison.errors.empty() ? "all the same" : "",
                {{"errors", array_of(comparison.errors)}});
    summary.add("worse", some_of(lines_of(changes_that(comparison.errors, true))));
    summary.add("better", some_of(lines_of(changes_that(comparison.errors, false))));
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
                      {"beyond", above_limits(compared.comparison, limits)}});
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
    compared.same_machine = may_compare_times(compared.before.machine, compared.after.machine) &&
                            compared.before.settings.threads == compared.after.settings.threads;
    compared.comparison = compare_reports(compared.before.experiments, compared.after.experiments);
    return compared;
}

/// Refuses limits on values that the reports do not have.
void require_common_values(const CompareOptions& options, const ComparedReports& compared) {
    const ReportComparison& comparison = compared.comparison;
    const std::string old_name = options.before.string();
    if (comparison.methods == 0) {
        throw failure(options.after, fmt::format("has no method on the same input as {}", old_name),
                      "run the same subjects, both with --quick or both without");
    }
    if (options.limits.max_slower && comparison.times.empty()) {
        throw failure(options.after,
                      fmt::format("has times of fewer than 6 methods in common with {}, so "
                                  "--max-slower cannot be checked",
                                  old_name),
                      "run more subjects, both without --no-times");
    }
    if (options.limits.max_slower && !compared.same_machine) {
        throw failure(options.after,
                      fmt::format("was measured on another machine than {} ({}), so --max-slower "
                                  "cannot be checked",
                                  old_name, difference_of(compared.before, compared.after)),
                      "run both on the same machine");
    }
    if (options.limits.max_memory_growth && comparison.with_memory == 0) {
        throw failure(options.after,
                      fmt::format("has no method in common with {} whose memory is known, so "
                                  "--max-memory-growth cannot be checked",
                                  old_name),
                      "run subjects that measure it (normals, tangents, bump, storage), both "
                      "without --no-times");
    }
}

ExitCode judge(const CLI::App& app, const CompareOptions& options,
               const ComparedReports& compared) {
    const std::vector<std::string> lines = above_limits(compared.comparison, options.limits);
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

void add_options(CLI::App& app, CompareOptions& options) {
    add_file(app, "OLD", options.before, "The old report: accuracy.json of an earlier run.");
    add_file(app, "NEW", options.after, "The new report: accuracy.json of a later run.");
    const Range range{0.0, std::numeric_limits<double>::max(), "percent"};
    const char* group = "Verdict";
    add_number(app, "--max-slower", "PERCENT", options.limits.max_slower, range,
               "Exit with 1 if the methods of a subject, or all methods, take longer on one thread "
               "by more than this and by more than 15 %, up to which runs are tied: if the whole "
               "confidence "
               "interval of the median ratio is above it. With any limit, a missing method also "
               "counts.")
        .group(group);
    add_number(app, "--max-error-growth", "PERCENT", options.limits.max_error_growth, range,
               "Exit with 1 if an error figure of a method, or a point of a curve, increases by "
               "more than this, or no longer has a result.")
        .group(group);
    add_number(app, "--max-memory-growth", "PERCENT", options.limits.max_memory_growth, range,
               "Exit with 1 if the memory of a method increases by more than this, and by at least "
               "10 % and one megabyte.")
        .group(group);
    add_switch(app, "--json", options.json,
               "Print one JSON object instead of text; docs/accuracy-schema.md describes it.");
    add_switch(app, "--quiet", options.quiet, "Print only errors; the exit code is the result.");
    set_examples(app, {"relief-accuracy run storage --quick --output out/old",
                       "relief-accuracy run storage --quick --output out/new",
                       "relief-accuracy compare out/old/accuracy.json out/new/accuracy.json",
                       "relief-accuracy compare out/old/accuracy.json out/new/accuracy.json "
                       "--max-error-growth 1 --json"});
}

}  // namespace

Command add_report_compare_command(CLI::App& tool) {
    return add_command<CompareOptions>(
        tool, "compare", "Compares the times, errors and memory of two reports.", add_options, run);
}

}  // namespace relief::tools
