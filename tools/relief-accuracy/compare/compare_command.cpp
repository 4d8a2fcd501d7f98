// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy compare OLD NEW`: what became faster, slower, more or less exact, and whether
// that is too much. Tests: tests/tools/accuracy_compare_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/options.h"
#include "common/text.h"
#include "compare/comparison_text.h"
#include "report_json.h"

namespace relief::tools {
namespace {

struct CompareOptions {
    std::filesystem::path before;
    std::filesystem::path after;
    ComparisonBounds bounds;
    bool json = false;
    bool quiet = false;
};

ComparedReports compared_reports(const CompareOptions& options) {
    ComparedReports compared;
    compared.before = read_report(options.before);
    compared.after = read_report(options.after);
    compared.same_machine = may_compare_times(compared.before, compared.after);
    std::optional<double> max_ratio;
    if (options.bounds.max_slower) max_ratio = 1.0 + *options.bounds.max_slower / 100.0;
    compared.found = compare_reports(compared.before.experiments, compared.after.experiments,
                                     compared.same_machine, max_ratio);
    return compared;
}

/// Bounds on what is not there would always be kept.
void require_something_to_judge(const CompareOptions& options, const ComparedReports& compared) {
    const ReportComparison& found = compared.found;
    if (found.methods == 0) {
        throw failure(options.after,
                      fmt::format("has no method on the same input as {}", options.before.string()),
                      "run the same subjects, both with --quick or both without");
    }
    if (options.bounds.max_slower && found.times.empty()) {
        throw failure(options.after,
                      fmt::format("has no times in common with {}, so that --max-slower says "
                                  "nothing",
                                  options.before.string()),
                      "run both without --no-times");
    }
    if (options.bounds.max_memory_growth && found.with_memory == 0) {
        throw failure(options.after,
                      fmt::format("has no method in common with {} whose memory is known, so that "
                                  "--max-memory-growth says nothing",
                                  options.before.string()),
                      "run subjects that measure it (normals, tangents, bump, storage), both "
                      "without --no-times");
    }
}

ExitCode judge(const CLI::App& app, const CompareOptions& options,
               const ComparedReports& compared) {
    const std::vector<std::string> lines = beyond(compared, options.bounds);
    if (lines.empty()) return ExitCode::done;
    std::string text = fmt::format("{}: {}", options.after.string(), lines.front());
    if (lines.size() > 1) text += fmt::format(", and {} more beyond bounds", lines.size() - 1);
    complain(app, text);
    return ExitCode::failed;
}

ExitCode run(const CLI::App& app, const CompareOptions& options) {
    if (options.json && options.quiet) throw UsageError("--json and --quiet contradict each other");
    const ComparedReports compared = compared_reports(options);
    require_something_to_judge(options, compared);
    if (options.json)
        print_json(json_of(compared, options.bounds));
    else if (!options.quiet)
        print_text(compared);
    return judge(app, options, compared);
}

}  // namespace

Command add_report_compare_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "compare",
                       "Says what became faster, slower, more or less exact between two reports.");
    const auto options = std::make_shared<CompareOptions>();
    add_file(app, "OLD", options->before,
             "Report to compare with: accuracy.json of an earlier run.");
    add_file(app, "NEW", options->after, "Report of a later run.");
    const Range range{0.0, std::numeric_limits<double>::max(), "percent"};
    const char* group = "Verdict";
    add_number(app, "--max-slower", "PERCENT", options->bounds.max_slower, range,
               "Exit with 1 if a method, or the median of all methods, takes longer by more than "
               "this, beyond what equal runs differ by; or if the times are too unsteady to tell. "
               "With any bound, a method that is gone is beyond it.")
        .group(group);
    add_number(app, "--max-error-growth", "PERCENT", options->bounds.max_error_growth, range,
               "Exit with 1 if a figure of a method's error, or a point of a curve, grew by more "
               "than this, or has no usable result any more.")
        .group(group);
    add_number(app, "--max-memory-growth", "PERCENT", options->bounds.max_memory_growth, range,
               "Exit with 1 if a method holds more memory than this beyond what it did, by at "
               "least a tenth and a megabyte.")
        .group(group);
    add_switch(app, "--json", options->json,
               "Print one JSON object instead of text; docs/accuracy-schema.md describes it.");
    add_switch(app, "--quiet", options->quiet, "Print nothing but errors; the exit code tells.");
    set_examples(app, {"relief-accuracy run storage --quick --output out/old",
                       "relief-accuracy run storage --quick --output out/new",
                       "relief-accuracy compare out/old/accuracy.json out/new/accuracy.json",
                       "relief-accuracy compare out/old/accuracy.json out/new/accuracy.json "
                       "--max-error-growth 1 --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
