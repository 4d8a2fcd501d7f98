// SPDX-License-Identifier: Apache-2.0
/// \file
/// What every tool of relief does alike: exit codes, the form of errors, --help, --version, stages
/// with their times, and progress, which goes to stderr and only to a terminal.
///
/// Errors read "relief-bake: error: high.obj: no texture coordinates (remedy)", whether the file,
/// the data or the command line is at fault. Tests: tests/tools/command_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relief/mesh/error.h"
#include "relief/mesh/timing.h"

/// The parser of command lines: a heavy header, for the few files that call it.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace relief::tools {

enum class ExitCode : int {
    done = 0,
    failed = 1,
    wrong_usage = 2,
    fell_back = 3,  ///< Done, but --strict was given and something is in the report.
};

/// A command line that contradicts itself or asks for what cannot be. Exit code 2.
class UsageError : public std::runtime_error {
  public:
    /// \param remedy  what to do instead; empty: the reader is sent to --help
    explicit UsageError(const std::string& problem, std::string remedy = "")
        : std::runtime_error(problem), remedy_(std::move(remedy)) {}

    [[nodiscard]] const std::string& remedy() const { return remedy_; }

  private:
    std::string remedy_;
};

/// "FILE: PROBLEM (REMEDY)", for what is wrong in a file's contents. Exit code 1.
FileError failure(const std::filesystem::path& file, const std::string& problem,
                  const std::string& remedy);

/// Checks, before any work is done, that the folder in which a file is to be written exists.
/// \throws FileError if it does not
void require_folder_of(const std::filesystem::path& file);

/// Makes a folder to write to, with those above it; one that exists is as good.
/// \throws FileError if it cannot be made
void make_folder(const std::filesystem::path& folder);

/// Runs `work` and names `file` in whatever InvalidInput it throws.
template <typename Work>
auto about(const std::filesystem::path& file, Work&& work) {
    try {
        return std::forward<Work>(work)();
    } catch (const InvalidInput& error) {
        throw FileError(file, error.what());
    }
}

/// A step of the work and the wall-clock time that it took.
struct Stage {
    std::string name;
    double milliseconds = 0;
};

/// Times the steps of a command; on a terminal, says on stderr which one is going on.
class Stages {
  public:
    explicit Stages(bool quiet);

    template <typename Work>
    auto run(const std::string& name, Work&& work) {
        const Running running(*this, name, name);
        return std::forward<Work>(work)();
    }

    /// The same, with other words on the terminal: "draw 3 of 24".
    template <typename Work>
    auto run(const std::string& name, const std::string& shown, Work&& work) {
        const Running running(*this, name, shown);
        return std::forward<Work>(work)();
    }

    /// Adds to the time of a step what was measured elsewhere.
    void book(const std::string& name, double milliseconds);

    /// Whether there is a terminal to say it on.
    [[nodiscard]] bool shows_progress() const { return show_; }
    /// On a terminal, says how far something is, 0 to 1, wherever it is told anew in percent.
    /// \param more  what else to say then: "3 s left"
    void show_progress(const std::string& name, double part, const std::string& more = "");
    void clear_progress() const;

    [[nodiscard]] const std::vector<Stage>& finished() const { return finished_; }
    [[nodiscard]] double milliseconds(std::string_view name) const;

  private:
    /// Books the time of one step when it goes out of scope, by an exception too.
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

/// One command of a tool: where its options stand, and what it does once they are parsed.
struct Command {
    CLI::App* app = nullptr;
    std::function<ExitCode()> run;
};

/// A tool: its name, what it is for in one sentence, and its commands.
struct Tool {
    std::string name;
    std::string sentence;
    /// Each adds its options to the tool, or to a subcommand that it makes there.
    std::vector<std::function<Command(CLI::App&)>> commands;
};

/// A subcommand with relief's help layout.
CLI::App& add_subcommand(CLI::App& tool, const std::string& name, const std::string& sentence);

/// Examples for the end of a --help page, one command a line. Each is run by a test.
void set_examples(CLI::App& app, const std::vector<std::string>& commands);

/// "process"
std::string command_name(const CLI::App& app);

/// Whether an option, "--cage", stood on the command line.
bool is_given(const CLI::App& app, const std::string& name);

/// Prints a warning in the form of the errors: "relief-mesh: warning: TEXT".
void warn(const CLI::App& app, const std::string& text);

/// Prints an error in the form of those that end a command, for one that goes on.
void complain(const CLI::App& app, const std::string& text);

/// All of main(): parses, runs the command, reports errors. \return the process's exit code
int run_tool(const Tool& tool, int argc, const char* const* argv);

/// "0.1.0"
std::string version();

}  // namespace relief::tools
