// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy run SUBJECT...`: runs experiments, prints a table of each, and writes them as a
// report. Tests: tests/tools/accuracy_run_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "accuracy_report.h"
#include "commands.h"
#include "common/options.h"
#include "common/text.h"
#include "parallel.h"
#include "relief/accuracy/subjects.h"
#include "relief/mesh/threads.h"
#include "report_files.h"
#include "report_json.h"
#include "report_table.h"

namespace relief::tools {
namespace {

struct RunCommandOptions {
    std::vector<std::string> words;
    std::optional<std::filesystem::path> output;
    bool quick = false;
    bool no_times = false;
    std::optional<int> repeats;
    bool json = false;
    GeneralOptions general;
};

constexpr int most_repeats = 1000;

std::string known_words() {
    std::string words = "all";
    for (const Subject subject : subjects_with_experiments())
        words += ", " + std::string(word_of(subject));
    return words;
}

/// What the words ask for, in the order of reports. \throws UsageError
std::vector<Subject> subjects_of(const std::vector<std::string>& words) {
    const std::vector<Subject> known = subjects_with_experiments();
    std::vector<Subject> asked;
    for (const std::string& word : words) {
        if (word == "all") {
            if (words.size() > 1) throw UsageError("all: the other subjects are in it");
            return known;
        }
        const auto found = std::find_if(known.begin(), known.end(),
                                        [&](Subject one) { return word_of(one) == word; });
        if (found == known.end())
            throw UsageError(fmt::format("{}: not one of {}", word, known_words()));
        if (std::find(asked.begin(), asked.end(), *found) != asked.end())
            throw UsageError(fmt::format("{}: given twice", word));
        asked.push_back(*found);
    }
    std::sort(asked.begin(), asked.end(), [&](Subject a, Subject b) {
        return std::find(known.begin(), known.end(), a) < std::find(known.begin(), known.end(), b);
    });
    return asked;
}

void check(const RunCommandOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    if (options.no_times && options.repeats)
        throw UsageError("--no-times and --repeats contradict each other");
    if (options.general.quiet && !options.output)
        throw UsageError("--quiet without --output would leave nothing of the results");
}

RunOptions run_options(const RunCommandOptions& options) {
    RunOptions run;
    run.is_quick = options.quick;
    run.is_timed = !options.no_times;
    run.threads = options.general.threads;
    // Fewer would be faster, but could not be compared: see compare_reports.h.
    if (options.quick) run.repeats.warm_up = 1;
    if (options.repeats) run.repeats.counted = static_cast<std::size_t>(*options.repeats);
    return run;
}

/// What repeats these subjects as they were run.
std::string command_for(const std::string& subjects, const RunCommandOptions& options) {
    std::string command = "relief-accuracy run " + subjects;
    if (options.quick) command += " --quick";
    if (options.no_times) command += " --no-times";
    if (options.repeats) command += fmt::format(" --repeats {}", *options.repeats);
    if (options.general.threads > 0)
        command += fmt::format(" --threads {}", options.general.threads);
    return command;
}

/// Runs the subjects one after another and prints each table as soon as it is there.
std::vector<Experiment> run_all(const std::vector<Subject>& subjects,
                                const RunCommandOptions& options, Stages& stages) {
    std::vector<Experiment> all;
    RunOptions run = run_options(options);
    for (std::size_t i = 0; i < subjects.size(); ++i) {
        const std::string subject(word_of(subjects[i]));
        run.tell = [&](const std::string& title, std::size_t done, std::size_t total) {
            const double within = static_cast<double>(done) / static_cast<double>(total);
            const double part =
                (static_cast<double>(i) + within) / static_cast<double>(subjects.size());
            stages.show_progress(fmt::format("{}, {} of {} ({}):", subject, done + 1, total, title),
                                 part);
        };
        std::vector<Experiment> found = run_experiments(subjects[i], run);
        stages.clear_progress();
        for (Experiment& experiment : found) {
            experiment.command = command_for(subject, options);
            if (!options.json && !options.general.quiet) fmt::print("{}\n", table_of(experiment));
            all.push_back(std::move(experiment));
        }
        std::fflush(stdout);
    }
    return all;
}

ExitCode run(const RunCommandOptions& options) {
    check(options);
    const std::vector<Subject> subjects = subjects_of(options.words);
    if (options.output) make_folder(*options.output);
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    AccuracyReport report;
    report.experiments = run_all(subjects, options, stages);
    report.relief = version();
    report.command = command_for(fmt::format("{}", fmt::join(options.words, " ")), options);
    const bool draws =
        std::find(subjects.begin(), subjects.end(), Subject::shading) != subjects.end();
    report.machine = this_machine(draws);
    const RunOptions run = run_options(options);
    report.settings = {.quick = options.quick,
                       .timed = run.is_timed,
                       .repeats = run.is_timed ? run.repeats.counted : 0,
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
            fmt::print("* on the efficient frontier: no method here is both as exact and faster\n");
        print_entry("written", written);
    }
    return ExitCode::done;
}

}  // namespace

Command add_run_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "run", "Measures methods on inputs whose truth is known, each with error and time.");
    const auto options = std::make_shared<RunCommandOptions>();
    app.add_option("SUBJECT", options->words,
                   fmt::format("What to measure, one or more of {}.", known_words()))
        ->required();
    add_value(
        app, "--output", "DIR",
        "Folder to write to: report.html (plots to look into, in one file), accuracy.json, "
        "accuracy.csv (a row for each measurement), accuracy-curves.csv (a row for each point of a "
        "curve) and pictures/. It is made where it does not exist. Default: nothing is written.",
        [options](const std::string&, const std::string& text) { options->output = text; });
    add_switch(app, "--json", options->json,
               "Print the report as JSON instead of tables; docs/accuracy-schema.md describes it.");
    const char* group = "Effort";
    add_switch(app, "--quick", options->quick,
               "Small inputs and fewer repeats: all subjects in a minute or two.")
        .group(group);
    add_switch(app, "--no-times", options->no_times,
               "Errors alone, which are the same in each run.")
        .group(group);
    add_value(app, "--repeats", "N",
              "How often each time is taken, in turns with the other methods of its experiment, 3 "
              "to 1000. Default: 9, which is what `compare` needs among many methods.",
              [options](const std::string& subject, const std::string& text) {
                  options->repeats = parse_integer(subject, text, 3, most_repeats);
              })
        .group(group);
    add_general_options(app, options->general);
    set_examples(app, {"relief-accuracy run storage --quick --output out/accuracy",
                       "relief-accuracy run storage --quick --no-times --json"});
    return {&app, [options] { return run(*options); }};
}

}  // namespace relief::tools
