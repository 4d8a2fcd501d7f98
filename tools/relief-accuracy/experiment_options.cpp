// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/accuracy_run_test.cpp, accuracy_own_test.cpp.
#include "experiment_options.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/command.h"
#include "common/text.h"
#include "parallel.h"
#include "relief/mesh/execution.h"

namespace relief::tools {
namespace {

constexpr int max_repeats = 1000;

}  // namespace

void add_experiment_options(CLI::App& app, ExperimentOptions& options) {
    add_value(app, "--output", "DIR",
              "Output folder for report.html (interactive plots in one file), accuracy.json, "
              "accuracy.csv (a row per measurement), accuracy-curves.csv (a row per point of a "
              "curve) and pictures/. It is created if necessary. Default: no files are written.",
              [&options](const std::string&, const std::string& text) { options.output = text; });
    add_switch(app, "--json", options.json,
               "Print the report as JSON instead of tables; docs/accuracy-schema.md describes it.");
    const char* group = "Effort";
    add_switch(app, "--quick", options.quick, "Use small inputs: all subjects take a few minutes.")
        .group(group);
    add_switch(
        app, "--no-times", options.no_times,
        "Measure only errors, which are the same in each run (with OpenGL, on the same renderer).")
        .group(group);
    add_value(
        app, "--repeats", "N",
        "The number of rounds of each time, interleaved with the other methods of the experiment, "
        "3 to 1000. With more rounds, `compare` detects smaller changes. Default: 10.",
        [&options](const std::string& subject, const std::string& text) {
            options.repeats = parse_integer(subject, text, 3, max_repeats);
        })
        .group(group);
    add_general_options(app, options.general);
}

void check(const ExperimentOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    if (options.no_times && options.repeats)
        throw UsageError("--no-times and --repeats contradict each other");
    if (options.general.quiet && !options.output)
        throw UsageError("--quiet without --output would discard the results");
}

RunOptions run_options(const ExperimentOptions& options) {
    RunOptions run;
    run.is_quick = options.quick;
    run.is_timed = !options.no_times;
    run.threads = options.general.threads;
    if (options.repeats) run.repeats.counted = static_cast<std::size_t>(*options.repeats);
    return run;
}

std::string effort_options(const ExperimentOptions& options) {
    std::string text;
    if (options.quick) text += " --quick";
    if (options.no_times) text += " --no-times";
    if (options.repeats) text += fmt::format(" --repeats {}", *options.repeats);
    if (options.general.threads > 0) text += fmt::format(" --threads {}", options.general.threads);
    return text;
}

bool prints_tables(const ExperimentOptions& options) {
    return !options.json && !options.general.quiet;
}

void prepare(const ExperimentOptions& options) {
    if (options.output) make_folder(*options.output);
    set_thread_limit(options.general.threads);
}

void finish_report(const ExperimentOptions& options, AccuracyReport report, bool draws) {
    const RunOptions run = run_options(options);
    report.relief = version();
    report.machine = this_machine(draws);
    report.settings = {.quick = options.quick,
                       .timed = run.is_timed,
                       .repeats = run.is_timed ? run.repeats.counted : 0,
                       .passes = report.settings.passes,
                       .threads = static_cast<unsigned>(thread_count())};
    std::vector<std::string> written;
    if (options.output) {
        for (const std::filesystem::path& file : write_report(*options.output, report))
            written.push_back(file_and_size(file));
    }
    if (options.json) {
        print_json(json_of(report, options.output.has_value()));
    } else if (!options.general.quiet) {
        if (!options.no_times)
            fmt::print(out(),
                       "* efficient: no other method is both faster and at least as accurate\n"
                       "± half of the range from the 10th to the 90th percentile of the rounds, in "
                       "percent of the median\n");
        print_entry("written", written);
    }
}

}  // namespace relief::tools
