// SPDX-License-Identifier: Apache-2.0
/// \file
/// The common behavior of all tools: exit codes, error messages, --help, --version, and stages with
/// their times. Progress is printed only if stderr is a terminal.
///
/// All errors have the form "relief-bake: error: high.obj: no texture coordinates (remedy)".
/// Tests: tests/tools/command_test.cpp.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

// <CLI/CLI.hpp> is a large header, so only few files include it.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace relief::tools {

enum class ExitCode : int {
    done = 0,
    failed = 1,
    wrong_usage = 2,
    fell_back = 3,  ///< Done, but --strict was given and there are findings.
};

/// An error in the command line. Exit code 2.
class UsageError : public std::runtime_error {
  public:
    /// \param remedy  the suggestion to the user; empty: the message refers to --help
    explicit UsageError(const std::string& problem, std::string remedy = "")
        : std::runtime_error(problem), remedy_(std::move(remedy)) {}

    [[nodiscard]] const std::string& remedy() const { return remedy_; }

  private:
    std::string remedy_;
};

/// Returns an error of std::filesystem in the form of a FileError.
FileError file_error(const std::filesystem::filesystem_error& error);

/// Returns the error "FILE: PROBLEM (REMEDY)". Exit code 1.
FileError failure(const std::filesystem::path& file, const std::string& problem,
                  const std::string& remedy);

/// Checks that the folder of an output file exists. \throws FileError
void require_folder_of(const std::filesystem::path& file);

/// Creates a folder with its parents if it does not exist. \throws FileError
void make_folder(const std::filesystem::path& folder);

/// Runs `work`, and replaces InvalidInput by a FileError with the name of the file.
template <typename Work>
auto about(const std::filesystem::path& file, Work&& work) {
    try {
        return std::forward<Work>(work)();
    } catch (const InvalidInput& error) {
        throw FileError(file, error.what());
    }
}

/// A step of a command and its wall-clock time.
struct Stage {
    std::string name;
    double milliseconds = 0;
};

/// Measures the steps of a command, and shows the current one if stderr is a terminal.
class Stages {
  public:
    explicit Stages(bool quiet);

    template <typename Work>
    auto run(const std::string& name, Work&& work) {
        const Running running(*this, name, name);
        return std::forward<Work>(work)();
    }

    /// The same with another text on the terminal: "draw 3 of 24".
    template <typename Work>
    auto run(const std::string& name, const std::string& shown, Work&& work) {
        const Running running(*this, name, shown);
        return std::forward<Work>(work)();
    }

    /// Adds time to a step that was measured elsewhere.
    void book(const std::string& name, double milliseconds);

    /// Returns whether progress is shown.
    [[nodiscard]] bool shows_progress() const { return show_; }
    /// Shows the completed fraction, 0 to 1, whenever the percentage changes.
    /// \param more  additional text: "3 s left"
    void show_progress(const std::string& name, double part, const std::string& more = "");
    void clear_progress() const;

    [[nodiscard]] const std::vector<Stage>& finished() const { return finished_; }
    [[nodiscard]] double milliseconds(std::string_view name) const;
    /// Returns the sum of all steps.
    [[nodiscard]] double milliseconds() const;

  private:
    /// Adds the time of a step at the end of its scope, also after an exception.
    class Running {
      public:
        Running(Stages& stages, const std::string& name, const std::string& shown);
        ~Running();
        Running(const Running&) = delete;
        Running& operator=(const Running&) = delete;

      private:
        Stages& stages_;
        std::size_t index_;
        Stopwatch stopwatch_;
    };

    std::size_t index_of(const std::string& name);

    bool show_;
    int shown_percent_ = -1;
    std::vector<Stage> finished_;
};

/// A command of a tool, with its options and its function.
struct Command {
    CLI::App* app = nullptr;
    std::function<ExitCode()> run;
};

/// A tool, described by one sentence, with its commands.
struct Tool {
    std::string name;
    std::string sentence;
    /// Each function adds its options to the tool or to a new subcommand.
    std::vector<std::function<Command(CLI::App&)>> commands;
};

/// Limits the data of this process, if a tool is all that it runs. Allocations beyond the limit
/// fail.
void limit_process_memory(std::uint64_t bytes);

/// Adds a subcommand, described by one sentence.
CLI::App& add_subcommand(CLI::App& tool, const std::string& name, const std::string& sentence);

/// Adds a subcommand whose options live as long as the tool.
/// \param add  adds the options to the subcommand
template <typename Options>
Command add_command(CLI::App& tool, const std::string& name, const std::string& sentence,
                    void (*add)(CLI::App&, Options&),
                    ExitCode (*run)(const CLI::App&, const Options&)) {
    CLI::App& app = add_subcommand(tool, name, sentence);
    const auto options = std::make_shared<Options>();
    add(app, *options);
    return {&app, [&app, options, run] { return run(app, *options); }};
}

/// Sets the examples at the end of the help page. A test runs each of them.
void set_examples(CLI::App& app, const std::vector<std::string>& commands);

/// Names the options of a long help page that most users need. The page lists the others, the
/// advanced ones, only for `--help all`. Without this call, all options are on the page.
void set_common_options(CLI::App& app, const std::vector<std::string>& names);

/// "process"
std::string command_name(const CLI::App& app);

/// Returns whether an option, "--cage", is on the command line.
bool is_given(const CLI::App& app, const std::string& name);

/// \throws UsageError if one of the options is on the command line, because all need another one
void refuse_given(const CLI::App& app, std::initializer_list<const char*> options,
                  const std::string& required, const std::string& remedy = "");

/// Prints a warning in the form of the errors: "relief-mesh: warning: TEXT".
void warn(const CLI::App& app, const std::string& text);

/// Prints an error without ending the command.
void complain(const CLI::App& app, const std::string& text);

/// Implements main(): handles signals, then runs the tool on the standard streams.
/// \return the exit code
int run_tool(const Tool& tool, int argc, const char* const* argv);

/// Parses the arguments, runs the tool and reports errors. Only one tool runs at a time in a
/// process.
///
/// \param arguments  without the program's name
/// \param out  the stream for results
/// \param err  the stream for errors, warnings and progress
/// \return the exit code for the process
int run_tool(const Tool& tool, const std::vector<std::string>& arguments, std::FILE* out,
             std::FILE* err);

/// The stream for results: standard output, unless a caller of run_tool() passed another.
std::FILE* out();

/// Prints to out(). An error is reported when the tool ends: files that it writes are the result,
/// and the text is their summary.
void print_text(std::string_view text);

/// The stream for errors, warnings and progress, likewise.
std::FILE* err();

/// The name of standard input or output in place of a file.
inline constexpr const char* standard_stream = "-";

/// Reserves out() for a JSON report: print_entry() and run_batch() print nothing. Lasts until the
/// tool ends.
void reserve_out_for_report();

/// Returns whether out() is reserved for a report.
bool is_out_reserved();

/// Returns whether err() is a terminal.
bool is_err_terminal();

/// "1.1.0"
std::string version();

/// "1.1.0 (commit 0123456789ab)"; without the commit if the sources do not say it.
std::string version_and_commit();

}  // namespace relief::tools
