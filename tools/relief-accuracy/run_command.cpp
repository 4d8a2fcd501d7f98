// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy run SUBJECT...` runs experiments, prints a table of each, and writes a report.
// Tests: tests/tools/accuracy_run_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "accuracy_report.h"
#include "commands.h"
#include "common/command.h"
#include "common/text.h"
#include "experiment_options.h"
#include "relief/accuracy/passes.h"
#include "relief/accuracy/subjects.h"

namespace relief::tools {
namespace {

constexpr int max_passes = 100;

struct RunCommandOptions {
    std::vector<std::string> words;
    std::optional<int> passes;
    ExperimentOptions how;

    /// The default is 3 passes: the median is robust if a third of the rounds is disturbed.
    [[nodiscard]] std::size_t pass_count() const {
        return how.no_times ? 1 : static_cast<std::size_t>(passes.value_or(3));
    }
};

std::string subject_choices() {
    std::string words = "all";
    for (const Subject subject : subjects_with_experiments())
        words += ", " + std::string(name_of(subject));
    return words;
}

/// Returns the requested subjects in the order of reports. \throws UsageError
std::vector<Subject> subjects_of(const std::vector<std::string>& words) {
    const std::vector<Subject> known = subjects_with_experiments();
    std::vector<Subject> requested;
    for (const std::string& word : words) {
        if (word == "all") {
            if (words.size() > 1) throw UsageError("all: includes the other subjects");
            return known;
        }
        const auto found = std::find_if(known.begin(), known.end(),
                                        [&](Subject one) { return name_of(one) == word; });
        if (found == known.end())
            throw UsageError(fmt::format("{}: not one of {}", word, subject_choices()));
        if (std::find(requested.begin(), requested.end(), *found) != requested.end())
            throw UsageError(fmt::format("{}: given twice", word));
        requested.push_back(*found);
    }
    std::sort(requested.begin(), requested.end(), [&](Subject a, Subject b) {
        return std::find(known.begin(), known.end(), a) < std::find(known.begin(), known.end(), b);
    });
    return requested;
}

/// Returns the command that repeats the run.
std::string command_for(const std::string& subjects, const RunCommandOptions& options) {
    const std::string passes = options.passes ? fmt::format(" --passes {}", *options.passes) : "";
    return "relief-accuracy run " + subjects + effort_options(options.how) + passes;
}

/// Runs all subjects. The last pass prints each table as soon as it is complete.
std::vector<Experiment> run_pass(const std::vector<Subject>& subjects,
                                 const RunCommandOptions& options, RunOptions run, std::size_t pass,
                                 Stages& stages) {
    const std::size_t passes = options.pass_count();
    const bool prints = prints_tables(options.how) && pass + 1 == passes;
    std::vector<Experiment> all;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
        const std::string subject(name_of(subjects[i]));
        run.tell = [&](const std::string& title, std::size_t done, std::size_t total) {
            const auto parts = static_cast<double>(passes * subjects.size());
            const double within = static_cast<double>(done) / static_cast<double>(total);
            const double part = (static_cast<double>(pass * subjects.size() + i) + within) / parts;
            stages.show_progress(fmt::format("pass {} of {}, {}, {} of {} ({}):", pass + 1, passes,
                                             subject, done + 1, total, title),
                                 part);
        };
        std::vector<Experiment> found = run_experiments(subjects[i], run);
        stages.clear_progress();
        for (Experiment& experiment : found) {
            experiment.command = command_for(subject, options);
            if (prints) fmt::print(out(), "{}\n", table_of(experiment));
            all.push_back(std::move(experiment));
        }
        std::fflush(out());
    }
    return all;
}

void check(const RunCommandOptions& options) {
    check(options.how);
    if (!options.passes) return;
    if (options.how.no_times) throw UsageError("--no-times and --passes contradict each other");
    const std::size_t rounds = run_options(options.how).repeats.counted;
    if (options.pass_count() > rounds) {
        throw UsageError(fmt::format("--passes {}: more than the {} of each time", *options.passes,
                                     counted(rounds, "round")),
                         "give more --repeats");
    }
}

ExitCode run(const RunCommandOptions& options) {
    check(options);
    const std::vector<Subject> subjects = subjects_of(options.words);
    prepare(options.how);
    Stages stages(options.how.general.quiet);
    AccuracyReport report;
    report.experiments = run_in_passes(options.pass_count(), run_options(options.how),
                                       [&](const RunOptions& run, std::size_t pass) {
                                           return run_pass(subjects, options, run, pass, stages);
                                       });
    report.settings.passes = options.pass_count();
    report.command = command_for(fmt::format("{}", fmt::join(options.words, " ")), options);
    const bool draws = std::any_of(subjects.begin(), subjects.end(), uses_opengl);
    finish_report(options.how, std::move(report), draws);
    return ExitCode::done;
}

}  // namespace

Command add_run_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "run", "Measures the error and time of methods on inputs with a known ground truth.");
    const auto options = std::make_shared<RunCommandOptions>();
    app.add_option("SUBJECT", options->words,
                   fmt::format("The subjects to measure, one or more of {}.", subject_choices()))
        ->required();
    add_experiment_options(app, options->how);
    add_value(
        app, "--passes", "N",
        "The number of passes over all experiments, 1 to 100. The repeats are distributed over the "
        "passes, so that a disturbance of the machine affects only one pass. Default: 3.",
        [options](const std::string& subject, const std::string& text) {
            options->passes = parse_integer(subject, text, 1, max_passes);
        })
        .group("Effort");
    set_examples(app, {"relief-accuracy run storage --quick --output out/accuracy",
                       "relief-accuracy run storage --quick --no-times --json"});
    return {&app, [options] { return run(*options); }};
}

}  // namespace relief::tools
