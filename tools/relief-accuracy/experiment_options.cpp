// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/accuracy_run_test.cpp, accuracy_own_test.cpp.
#include "experiment_options.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/console.h"
#include "common/text.h"
#include "parallel.h"
#include "relief/mesh/threads.h"
#include "report_files.h"
#include "report_json.h"

namespace relief::tools {
namespace {

constexpr int most_repeats = 1000;

}  // namespace

void add_experiment_options(CLI::App& app, ExperimentOptions& options) {
    add_value(
        app, "--output", "DIR",
        "Folder to write to: report.html (plots to look into, in one file), accuracy.json, "
        "accuracy.csv (a row for each measurement), accuracy-curves.csv (a row for each point of a "
        "curve) and pictures/. It is made where it does not exist. Default: nothing is written.",
        [&options](const std::string&, const std::string& text) { options.output = text; });
    add_switch(app, "--json", options.json,
               "Print the report as JSON instead of tables; docs/accuracy-schema.md describes it.");
    const char* group = "Effort";
    add_switch(app, "--quick", options.quick, "Small inputs: all subjects in a few minutes.")
        .group(group);
    add_switch(app, "--no-times", options.no_times,
               "Errors alone, which are the same in each run; of what OpenGL draws, with the same "
               "renderer.")
        .group(group);
    add_value(app, "--repeats", "N",
              "How often each time is taken, in turns with the other methods of its experiment, 3 "
              "to 1000; more let `compare` see smaller changes. Default: 10.",
              [&options](const std::string& subject, const std::string& text) {
                  options.repeats = parse_integer(subject, text, 3, most_repeats);
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
        throw UsageError("--quiet without --output would leave nothing of the results");
}

RunOptions run_options(const ExperimentOptions& options) {
    RunOptions run;
    run.is_quick = options.quick;
    run.is_timed = !options.no_times;
    run.threads = options.general.threads;
    if (options.repeats) run.repeats.counted = static_cast<std::size_t>(*options.repeats);
    return run;
}

std::string effort_words(const ExperimentOptions& options) {
    std::string words;
    if (options.quick) words += " --quick";
    if (options.no_times) words += " --no-times";
    if (options.repeats) words += fmt::format(" --repeats {}", *options.repeats);
    if (options.general.threads > 0) words += fmt::format(" --threads {}", options.general.threads);
    return words;
}

bool prints_tables(const ExperimentOptions& options) {
    return !options.json && !options.general.quiet;
}

void prepare(const ExperimentOptions& options) {
    if (options.output) make_folder(*options.output);
    set_thread_limit(options.general.threads);
}

void hand_over(const ExperimentOptions& options, AccuracyReport report, bool draws) {
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
                       "* efficient: no other method here is both as accurate and faster\n"
                       "± half of the range from the 10th to the 90th percentile of the rounds, in "
                       "percent of the median\n");
        print_entry("written", written);
    }
}

}  // namespace relief::tools
