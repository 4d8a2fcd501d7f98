// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy run SUBJECT...`: runs experiments, prints a table of each, and writes them as a
// report. Tests: tests/tools/accuracy_run_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "accuracy_report.h"
#include "commands.h"
#include "experiment_options.h"
#include "relief/accuracy/subjects.h"
#include "report_table.h"

namespace relief::tools {
namespace {

struct RunCommandOptions {
    std::vector<std::string> words;
    ExperimentOptions how;
};

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

/// What repeats these subjects as they were run.
std::string command_for(const std::string& subjects, const RunCommandOptions& options) {
    return "relief-accuracy run " + subjects + effort_words(options.how);
}

/// Runs the subjects one after another and prints each table as soon as it is there.
std::vector<Experiment> run_all(const std::vector<Subject>& subjects,
                                const RunCommandOptions& options, Stages& stages) {
    std::vector<Experiment> all;
    RunOptions run = run_options(options.how);
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
            if (prints_tables(options.how)) fmt::print("{}\n", table_of(experiment));
            all.push_back(std::move(experiment));
        }
        std::fflush(stdout);
    }
    return all;
}

ExitCode run(const RunCommandOptions& options) {
    check(options.how);
    const std::vector<Subject> subjects = subjects_of(options.words);
    prepare(options.how);
    Stages stages(options.how.general.quiet);
    AccuracyReport report;
    report.experiments = run_all(subjects, options, stages);
    report.command = command_for(fmt::format("{}", fmt::join(options.words, " ")), options);
    const bool draws =
        std::find(subjects.begin(), subjects.end(), Subject::shading) != subjects.end();
    hand_over(options.how, std::move(report), draws);
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
    add_experiment_options(app, options->how);
    set_examples(app, {"relief-accuracy run storage --quick --output out/accuracy",
                       "relief-accuracy run storage --quick --no-times --json"});
    return {&app, [options] { return run(*options); }};
}

}  // namespace relief::tools
