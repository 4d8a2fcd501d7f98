// SPDX-License-Identifier: Apache-2.0
// Every error, also of CLI11, becomes one line on stderr and an exit code.
#include "common/command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>
#include <sstream>

#include "file_replacement.h"
#include "near_names.h"
#include "relief/mesh/execution.h"
#include "relief/version.h"

namespace relief::tools {
namespace {

/// The streams of the running tool.
struct Console {
    std::FILE* out = stdout;
    std::FILE* err = stderr;
};
Console console;

/// Replaces the streams for its lifetime.
class ConsoleScope {
  public:
    ConsoleScope(std::FILE* out, std::FILE* err) : before_(console) { console = {out, err}; }
    ~ConsoleScope() { console = before_; }
    ConsoleScope(const ConsoleScope&) = delete;
    ConsoleScope& operator=(const ConsoleScope&) = delete;

  private:
    Console before_;
};

constexpr std::size_t page_columns = 100;
constexpr std::size_t text_column = 30;

/// Returns a name with the text wrapped beside it.
std::string help_entry(const std::string& name, const std::string& text) {
    std::string page = "  " + name;
    std::size_t column = page.size();
    if (column + 2 > text_column) {
        page += '\n';
        column = 0;
    }
    std::istringstream words(text);
    bool line_start = true;
    for (std::string word; words >> word;) {
        if (!line_start && column + 1 + word.size() > page_columns) {
            page += '\n';
            column = 0;
            line_start = true;
        }
        if (line_start) {
            page.append(text_column - column, ' ');
            column = text_column;
        } else {
            page += ' ';
            ++column;
        }
        page += word;
        column += word.size();
        line_start = false;
    }
    return page + '\n';
}

std::string help_usage(const CLI::App& app) {
    std::string text = "\nUsage: ";
    if (app.get_parent() != nullptr) text += app.get_parent()->get_name() + " ";
    text += app.get_name();
    if (!app.get_subcommands({}).empty()) return text + " COMMAND ...\n";
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional()) text += " " + option->get_name(true, false);
    }
    return text + " [OPTIONS]\n";
}

std::string help_commands(const CLI::App& app) {
    if (app.get_subcommands({}).empty()) return "";
    std::string page = "\nCommands:\n";
    for (const CLI::App* command : app.get_subcommands({}))
        page += help_entry(command->get_name(), command->get_description());
    return page + fmt::format("\n{} COMMAND --help describes a command.\n", app.get_name());
}

std::string help_arguments(const CLI::App& app) {
    std::string page;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_positional())
            page += help_entry(option->get_name(true, false), option->get_description());
    }
    return page.empty() ? "" : "\nArguments:\n" + page;
}

/// Returns the options of a group, or an empty text.
std::string help_options(const CLI::App& app, const std::string& title, const std::string& group) {
    std::string page;
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group() != group || option->get_positional()) continue;
        const bool takes_value = option->get_expected_max() > 0;
        const std::string value = takes_value ? " " + option->get_type_name() : "";
        page += help_entry(option->get_name(false, true) + value, option->get_description());
    }
    return page.empty() ? "" : fmt::format("\n{}:\n{}", title, page);
}

/// The layout of help pages, at most 100 columns wide.
class HelpFormat : public CLI::FormatterBase {
  public:
    std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
        const std::string general = "Options";  // CLI11's group of options without a group.
        std::string page = app->get_description() + "\n" + help_usage(*app);
        page += help_commands(*app) + help_arguments(*app);
        for (const std::string& group : app->get_groups()) {
            if (group != general && !group.empty()) page += help_options(*app, group, group);
        }
        page += help_options(*app, "General", general);
        if (!app->get_footer().empty()) page += "\n" + app->get_footer() + "\n";
        return page;
    }
};

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
    }
    return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({}))
        names.push_back(command->get_name());
    return names;
}

/// Returns the parsed command, or the tool itself.
const CLI::App& parsed_command(const CLI::App& root) {
    const std::vector<CLI::App*> parsed = root.get_subcommands();
    return parsed.empty() ? root : *parsed.front();
}

/// "relief-mesh process"
std::string full_name(const CLI::App& app) {
    const CLI::App* parent = app.get_parent();
    return parent == nullptr ? app.get_name() : parent->get_name() + " " + app.get_name();
}

/// Returns the error of an unknown option or command, or an excess file.
UsageError unexpected(const CLI::App& app, const std::string& argument) {
    const bool is_option = argument.size() > 1 && argument.front() == '-';
    const std::vector<std::string> commands = command_names(app);
    const std::string word = argument.substr(0, argument.find('='));
    const std::vector<std::string> suggestions =
        near_names(word, is_option ? option_names(app) : commands);
    const std::string remedy =
        suggestions.empty() ? "" : fmt::format("did you mean {}?", fmt::join(suggestions, " or "));
    if (is_option) return UsageError(word + ": unknown option", remedy);
    if (!commands.empty()) return UsageError(word + ": unknown command", remedy);
    return UsageError(argument + ": one argument too many");
}

/// Converts an error of CLI11.
UsageError usage_error(const CLI::App& root, const CLI::ParseError& error) {
    const CLI::App& app = parsed_command(root);
    const std::vector<std::string> remaining = app.remaining();
    if (!remaining.empty()) return unexpected(app, remaining.front());
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
        if (!command_names(app).empty())
            return UsageError(
                fmt::format("a command is missing: {}", fmt::join(command_names(app), " or ")));
        std::string what = error.what();
        what = what.substr(0, what.find(" is required"));
        return UsageError(what + " is missing");
    }
    const std::string what = error.what();
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ArgumentMismatch))
        return UsageError(what.substr(0, what.find(':')) + ": needs a value");
    return UsageError(what);
}

/// Prints "relief-mesh: error: TEXT" with the name of the tool, without the command.
void print_message(const CLI::App& app, const std::string& severity, const std::string& text) {
    const CLI::App* parent = app.get_parent();
    std::fflush(out());
    fmt::print(err(), "{}: {}: {}\n", parent == nullptr ? app.get_name() : parent->get_name(),
               severity, text);
}

void print_error(const CLI::App& root, const std::string& text) {
    print_message(root, "error", text);
}

int report(const CLI::App& root, const UsageError& error) {
    const std::string remedy = error.remedy().empty()
                                   ? fmt::format("see {} --help", full_name(parsed_command(root)))
                                   : error.remedy();
    print_error(root, fmt::format("{} ({})", error.what(), remedy));
    return static_cast<int>(ExitCode::wrong_usage);
}

int report_failure(const CLI::App& root, const std::string& text) {
    print_error(root, text);
    return static_cast<int>(ExitCode::failed);
}

/// Parses the arguments and runs the command.
int parse_and_run(CLI::App& root, const std::vector<Command>& commands,
                  const std::vector<std::string>& arguments) {
    try {
        root.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::Success& request) {  // --help and --version
        std::ostringstream text;
        const int code = root.exit(request, text, text);
        fmt::print(out(), "{}", text.str());
        return code;
    } catch (const CLI::ParseError& error) {
        throw usage_error(root, error);
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        const ExitCode code = command.run();
        if (std::fflush(out()) != 0 || std::ferror(out()) != 0)
            throw FileError("standard output", "cannot be written");
        return static_cast<int>(code);
    }
    throw UsageError("a command is missing");
}

/// Signals that end the process remove temporary files first. SIGPIPE and SIGXFSZ are ignored, so
/// that they become errors of writing.
void handle_signals() {
    remove_temporaries_on_signals();
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

std::FILE* out() {
    return console.out;
}

std::FILE* err() {
    return console.err;
}

bool is_err_terminal() {
    return ::isatty(::fileno(err())) == 1;
}

FileError failure(const std::filesystem::path& file, const std::string& problem,
                  const std::string& remedy) {
    return {file, fmt::format("{} ({})", problem, remedy)};
}

void require_folder_of(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.parent_path();
    if (folder.empty() || std::filesystem::is_directory(folder)) return;
    throw failure(file, fmt::format("the folder {} does not exist", folder.string()),
                  "create it first");
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!error || std::filesystem::is_directory(folder)) return;
    const std::filesystem::path name = folder.has_filename() ? folder : folder.parent_path();
    throw FileError(
        folder, std::filesystem::exists(name) ? "exists, but is not a folder" : error.message());
}

Stages::Stages(bool quiet) : show_(!quiet && is_err_terminal()) {}

double Stages::milliseconds(std::string_view name) const {
    double sum = 0;
    for (const Stage& stage : finished_) {
        if (stage.name == name) sum += stage.milliseconds;
    }
    return sum;
}

std::size_t Stages::index_of(const std::string& name) {
    const auto known = std::find_if(finished_.begin(), finished_.end(),
                                    [&](const Stage& stage) { return stage.name == name; });
    const auto index = static_cast<std::size_t>(known - finished_.begin());
    if (known == finished_.end()) finished_.push_back({name, 0});
    return index;
}

void Stages::book(const std::string& name, double milliseconds) {
    finished_[index_of(name)].milliseconds += milliseconds;
}

void Stages::show_progress(const std::string& name, double part, const std::string& more) {
    const int percent = static_cast<int>(part * 100);
    if (!show_ || percent == shown_percent_) return;
    shown_percent_ = percent;
    fmt::print(err(), "\r\033[K{} {} %{}{} ...", name, percent, more.empty() ? "" : ", ", more);
    std::fflush(err());
}

void Stages::clear_progress() const {
    if (!show_) return;
    fmt::print(err(), "\r\033[K");
    std::fflush(err());
}

Stages::Running::Running(Stages& stages, const std::string& name, const std::string& shown)
    : stages_(stages), index_(stages.index_of(name)) {
    if (stages.show_) {
        fmt::print(err(), "\r\033[K{} ...", shown);
        std::fflush(err());
    }
}

Stages::Running::~Running() {
    stages_.finished_[index_].milliseconds += 1e3 * stopwatch_.seconds();
    stages_.clear_progress();
}

CLI::App& add_subcommand(CLI::App& tool, const std::string& name, const std::string& sentence) {
    CLI::App& app = *tool.add_subcommand(name, sentence);
    app.formatter(std::make_shared<HelpFormat>());
    return app;
}

void set_examples(CLI::App& app, const std::vector<std::string>& commands) {
    app.footer(fmt::format("Examples:\n  {}", fmt::join(commands, "\n  ")));
}

std::string command_name(const CLI::App& app) {
    return app.get_name();
}

bool is_given(const CLI::App& app, const std::string& name) {
    return app.count(name) > 0;
}

void refuse_given(const CLI::App& app, std::initializer_list<const char*> options,
                  const std::string& required, const std::string& remedy) {
    for (const char* option : options) {
        if (is_given(app, option))
            throw UsageError(fmt::format("{}: has no effect without {}", option, required), remedy);
    }
}

void warn(const CLI::App& app, const std::string& text) {
    print_message(app, "warning", text);
}

void complain(const CLI::App& app, const std::string& text) {
    print_message(app, "error", text);
}

int run_tool(const Tool& tool, int argc, const char* const* argv) {
    handle_signals();
    return run_tool(tool, std::vector<std::string>(argv + 1, argv + argc), stdout, stderr);
}

int run_tool(const Tool& tool, const std::vector<std::string>& arguments, std::FILE* out,
             std::FILE* err) {
    const ConsoleScope streams(out, err);
    set_thread_limit(0);
    CLI::App root(tool.sentence, tool.name);
    root.formatter(std::make_shared<HelpFormat>());
    root.set_version_flag("--version", tool.name + " " + version(), "Print the version and exit.");
    root.set_help_flag("-h,--help", "Print this help and exit.");
    std::vector<Command> commands;
    for (const auto& add : tool.commands)
        commands.push_back(add(root));
    if (!root.get_subcommands({}).empty()) root.require_subcommand(1);

    try {
        return parse_and_run(root, commands, arguments);
    } catch (const UsageError& error) {
        return report(root, error);
    } catch (const std::bad_alloc&) {
        return report_failure(root, "out of memory");
    } catch (const std::exception& error) {
        return report_failure(root, error.what());
    }
}

std::string version() {
    return RELIEF_VERSION;
}

}  // namespace relief::tools
