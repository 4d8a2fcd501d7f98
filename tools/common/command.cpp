// SPDX-License-Identifier: Apache-2.0
// Every error, also of CLI11, becomes one line on stderr and an exit code.
#include "common/command.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/build_commit.h"
#include "common/help.h"
#include "common/text.h"
#include "file_replacement.h"
#include "near_names.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/limits.h"
#include "relief/version.h"

namespace relief::tools {
using namespace relief::detail;

namespace {

/// The streams of the running tool.
struct Console {
    std::FILE* out = stdout;
    std::FILE* err = stderr;
    bool is_out_reserved = false;
    int out_error = 0;             ///< The first error of printing to `out`.
    std::size_t files_before = 0;  ///< replaced_file_count() at the beginning.
};
Console console;

/// True if the tool is the whole process, rather than a call in a test.
bool owns_process = false;

// The shadow memory of sanitizers exceeds any limit.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

/// Replaces the streams for its lifetime.
class ConsoleScope {
  public:
    ConsoleScope(std::FILE* out, std::FILE* err) : before_(console) {
        console = {out, err, false, 0, replaced_file_count()};
    }
    ~ConsoleScope() { console = before_; }
    ConsoleScope(const ConsoleScope&) = delete;
    ConsoleScope& operator=(const ConsoleScope&) = delete;

  private:
    Console before_;
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

/// An option that an earlier version had.
struct RenamedOption {
    std::string_view before;
    std::string_view now;
    std::string_view values;  ///< The new values, if those have changed too.
};

constexpr std::array renamed_options = {
    RenamedOption{"--flat", "--zero-code", "127.5 for half, 128 for middle"},
    RenamedOption{"--input-flat", "--input-zero-code", "127.5 for half, 128 for middle"},
    RenamedOption{"--detail-flat", "--detail-zero-code", "127.5 for half, 128 for middle"},
};

/// Returns the error of an option that has another name in this command.
std::optional<UsageError> renamed(const std::vector<std::string>& options,
                                  std::string_view option) {
    for (const RenamedOption& row : renamed_options) {
        if (row.before != option || std::ranges::find(options, row.now) == options.end()) continue;
        return UsageError(fmt::format("{}: is now called {}", row.before, row.now),
                          fmt::format("give {} {}", row.now, row.values));
    }
    return std::nullopt;
}

/// Returns the error of an unknown option or command, or an excess file.
UsageError unexpected(const CLI::App& app, const std::string& argument) {
    const bool is_option = argument.size() > 1 && argument.front() == '-';
    const std::vector<std::string> commands = command_names(app);
    const std::string word = argument.substr(0, argument.find('='));
    if (is_option) {
        if (const auto error = renamed(option_names(app), word)) return *error;
    }
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

/// Keeps the first error.
void flush_out() {
    const bool is_flushed = std::fflush(out()) == 0;
    if (console.out_error != 0) return;
    if (!is_flushed)
        console.out_error = errno;
    else if (std::ferror(out()) != 0)
        console.out_error = EIO;
}

/// Prints to err(). A message that cannot be printed is lost; the exit code still tells the result.
template <typename... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    const std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), err()));
}

/// Returns a message without control characters. Lines after the first one, as in the messages of
/// shader compilers, are indented, so that they cannot look like messages of their own.
std::string indented_lines(std::string_view text) {
    std::string result = printable_lines(text);
    for (std::size_t end = result.find('\n'); end < result.size() - 1;
         end = result.find('\n', end + 1))
        result.insert(end + 1, "  ");
    return result;
}

/// Prints "relief-mesh: error: TEXT" with the name of the tool, without the command.
void print_message(const CLI::App& app, const std::string& severity, const std::string& text) {
    const CLI::App* parent = app.get_parent();
    flush_out();
    tell("{}: {}: {}\n", parent == nullptr ? app.get_name() : parent->get_name(), severity,
         indented_lines(text));
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

/// Returns the code if everything could be printed. If files were written, they are the result, and
/// a summary that cannot be printed is a warning.
/// \throws FileError if standard output was the result
int flushed(const CLI::App& root, int code) {
    flush_out();
    if (console.out_error == 0) return code;
    const bool has_files = replaced_file_count() > console.files_before;
    const bool is_summary = has_files && !console.is_out_reserved;
    const std::string problem =
        has_files ? "cannot be written (the output files are complete)" : "cannot be written";
    // A reader that closes its pipe, such as head, needs no message.
    const bool is_quiet = console.out_error == EPIPE;
    if (!is_summary && !is_quiet) throw FileError("standard output", problem);
    if (!is_quiet) print_message(root, "warning", "standard output: " + problem);
    return is_summary ? code : static_cast<int>(ExitCode::failed);
}

/// Adds the remedy to the error of oneTBB if no thread can be started.
std::string with_remedy(const std::string& error) {
    if (!error.starts_with("pthread_create")) return error;
    return fmt::format("no thread can be started: {} (raise the limit of processes, ulimit -u)",
                       error);
}

/// Parses the arguments and runs the command.
int parse_and_run(CLI::App& root, const std::vector<Command>& commands,
                  const std::vector<std::string>& arguments) {
    try {
        root.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::Success& request) {  // --help and --version
        std::ostringstream text;
        const int code = root.exit(request, text, text);
        print_text(text.str());
        return flushed(root, code);
    } catch (const CLI::ParseError& error) {
        throw usage_error(root, error);
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) continue;
        return flushed(root, static_cast<int>(command.run()));
    }
    throw UsageError("a command is missing");
}

constexpr const char* json_help = "--help-json";

/// A tool with its commands and options.
struct BuiltTool {
    explicit BuiltTool(const Tool& tool)
        : root(std::make_unique<CLI::App>(tool.sentence, tool.name)) {
        use_help_pages(*root);
        root->set_version_flag("--version", tool.name + " " + version_and_commit(),
                               "Print the version and exit.");
        root->set_help_flag("-h,--help", "Print this help and exit.");
        for (const auto& add : tool.commands)
            commands.push_back(add(*root));
        if (!root->get_subcommands({}).empty()) root->require_subcommand(1);
        root->add_flag(
            json_help,
            [](std::int64_t) {
                throw UsageError(std::string(json_help) + ": excludes all other arguments");
            },
            "Print the commands and options as JSON and exit.");
    }

    std::unique_ptr<CLI::App> root;
    std::vector<Command> commands;
};

/// Returns whether the arguments contain "--help all", and removes its second word.
bool take_help_all(std::vector<std::string>& arguments) {
    for (std::size_t i = 0; i + 1 < arguments.size(); ++i) {
        if ((arguments[i] != "--help" && arguments[i] != "-h") || arguments[i + 1] != "all")
            continue;
        arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        return true;
    }
    return false;
}

/// Opens standard descriptors that are closed, so that no output file gets their number. Writing to
/// them fails, as to a closed descriptor.
void occupy_standard_descriptors() {
    for (int descriptor = 0; descriptor < 3; ++descriptor) {
        if (::fcntl(descriptor, F_GETFD) < 0) ::open("/dev/null", O_RDONLY);
    }
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

void print_text(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), out()) != text.size() && console.out_error == 0)
        console.out_error = errno;
}

void reserve_out_for_report() {
    console.is_out_reserved = true;
}

bool is_out_reserved() {
    return console.is_out_reserved;
}

bool is_err_terminal() {
    return ::isatty(::fileno(err())) == 1;
}

FileError file_error(const std::filesystem::filesystem_error& error) {
    return {error.path1(), error.code().message()};
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

double Stages::milliseconds() const {
    double sum = 0;
    for (const Stage& stage : finished_)
        sum += stage.milliseconds;
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
    tell("\r\033[K{} {} %{}{} ...", printable(name), percent, more.empty() ? "" : ", ",
         printable(more));
    std::fflush(err());
}

void Stages::clear_progress() const {
    if (!show_) return;
    tell("\r\033[K");
    std::fflush(err());
}

Stages::Running::Running(Stages& stages, const std::string& name, const std::string& shown)
    : stages_(stages), index_(stages.index_of(name)) {
    if (stages.show_) {
        tell("\r\033[K{} ...", printable(shown));
        std::fflush(err());
    }
}

Stages::Running::~Running() {
    stages_.finished_[index_].milliseconds += 1e3 * stopwatch_.seconds();
    stages_.clear_progress();
}

void limit_process_memory(std::uint64_t bytes) {
    rlimit limit{};
    if (!owns_process || is_sanitized || ::getrlimit(RLIMIT_DATA, &limit) != 0) return;
    limit.rlim_cur = std::min<rlim_t>(bytes, limit.rlim_max);
    ::setrlimit(RLIMIT_DATA, &limit);
}

CLI::App& add_subcommand(CLI::App& tool, const std::string& name, const std::string& sentence) {
    return *tool.add_subcommand(name, sentence);
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
    owns_process = true;
    occupy_standard_descriptors();
    handle_signals();
    return run_tool(tool, std::vector<std::string>(argv + 1, argv + argc), stdout, stderr);
}

int run_tool(const Tool& tool, const std::vector<std::string>& given, std::FILE* out,
             std::FILE* err) {
    const ConsoleScope streams(out, err);
    set_thread_limit(0);
    set_input_limits({});
    const BuiltTool built(tool);
    CLI::App& root = *built.root;
    try {
        if (given == std::vector<std::string>{json_help}) {
            print_text(describe(root).dump(2) + "\n");
            return flushed(root, static_cast<int>(ExitCode::done));
        }
        std::vector<std::string> arguments = given;
        if (take_help_all(arguments)) show_advanced_options(root);
        return parse_and_run(root, built.commands, arguments);
    } catch (const UsageError& error) {
        return report(root, error);
    } catch (const std::bad_alloc&) {
        return report_failure(root, "out of memory");
    } catch (const std::filesystem::filesystem_error& error) {
        return report_failure(root, file_error(error).what());
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::broken_pipe) return static_cast<int>(ExitCode::failed);
        return report_failure(root, error.what());
    } catch (const std::exception& error) {
        return report_failure(root, with_remedy(error.what()));
    }
}

nlohmann::ordered_json describe(const Tool& tool) {
    return describe(*BuiltTool(tool).root);
}

std::string version() {
    return RELIEF_VERSION;
}

std::string version_and_commit() {
    const std::string commit = build_commit;
    return commit.empty() ? version() : fmt::format("{} (commit {})", version(), commit);
}

}  // namespace relief::tools
