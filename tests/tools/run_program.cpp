// SPDX-License-Identifier: Apache-2.0
#include "tools/run_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "support/shared_data.h"
#include "tools/linked_tools.h"

namespace relief::test {
namespace {

std::string contents_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Where the child's standard streams and working directory point.
class SpawnActions {
  public:
    SpawnActions() { posix_spawn_file_actions_init(&actions_); }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;

    void redirect(int stream, const std::filesystem::path& file, int flags) {
        posix_spawn_file_actions_addopen(&actions_, stream, file.c_str(), flags, 0600);
    }
    void change_folder(const std::filesystem::path& folder) {
        posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    }
    [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

  private:
    posix_spawn_file_actions_t actions_{};
};

/// Waits for the end, and sends a signal as soon as it is time.
int exit_code_of(pid_t child, const std::function<bool()>& is_time, int signal) {
    int status = 0;
    bool is_sent = is_time == nullptr;
    for (;;) {
        const pid_t ended = ::waitpid(child, &status, is_sent ? 0 : WNOHANG);
        if (ended == child) break;
        if (ended != 0) throw std::runtime_error("waitpid failed");
        if (is_time()) {
            ::kill(child, signal);
            is_sent = true;
        } else {
            ::usleep(500);
        }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// By name.
std::map<std::string, ToolEntry>& linked_tools() {
    static std::map<std::string, ToolEntry> tools;
    return tools;
}

/// Another working directory for its lifetime.
class WorkingDirectory {
  public:
    explicit WorkingDirectory(const std::filesystem::path& folder)
        : before_(std::filesystem::current_path()) {
        std::filesystem::current_path(folder);
    }
    ~WorkingDirectory() {
        std::error_code ignored;
        std::filesystem::current_path(before_, ignored);
    }
    WorkingDirectory(const WorkingDirectory&) = delete;
    WorkingDirectory& operator=(const WorkingDirectory&) = delete;

  private:
    std::filesystem::path before_;
};

/// A stream that writes to memory.
class MemoryStream {
  public:
    MemoryStream() : stream_(::open_memstream(&text_, &size_)) {
        if (stream_ == nullptr) throw std::runtime_error("open_memstream failed");
    }
    ~MemoryStream() {
        std::fclose(stream_);
        std::free(text_);
    }
    MemoryStream(const MemoryStream&) = delete;
    MemoryStream& operator=(const MemoryStream&) = delete;

    [[nodiscard]] std::FILE* stream() const { return stream_; }
    [[nodiscard]] std::string text() const {
        std::fflush(stream_);
        return {text_, size_};
    }

  private:
    char* text_ = nullptr;
    std::size_t size_ = 0;
    std::FILE* stream_;
};

ProgramResult run_linked(const ToolEntry& entry, const std::vector<std::string>& words,
                         const std::filesystem::path& folder) {
    const WorkingDirectory in(folder);
    const MemoryStream out;
    const MemoryStream err;
    const int code = entry({words.begin() + 1, words.end()}, out.stream(), err.stream());
    return {code, out.text(), err.text()};
}

}  // namespace

bool link_tool(const std::string& name, const ToolEntry& entry) {
    linked_tools()[name] = entry;
    return true;
}

std::optional<std::vector<std::string>> plain_text(const std::string& line) {
    constexpr std::string_view special = "|&;<>()$`\\*?[]#~!\n\t";
    constexpr std::string_view special_in_quotes = "$`\\";
    std::vector<std::string> words;
    bool in_word = false;
    char quote = 0;
    for (const char letter : line) {
        if (quote != 0) {
            if (letter == quote)
                quote = 0;
            else if (quote == '"' && special_in_quotes.find(letter) != std::string_view::npos)
                return std::nullopt;
            else
                words.back() += letter;
        } else if (letter == ' ') {
            in_word = false;
        } else if (special.find(letter) != std::string_view::npos) {
            return std::nullopt;
        } else {
            if (!in_word) words.emplace_back();
            in_word = true;
            if (letter == '\'' || letter == '"')
                quote = letter;
            else
                words.back() += letter;
        }
    }
    if (quote != 0 || words.empty() || words[0].find('=') != std::string::npos) return std::nullopt;
    return words;
}

std::string ProgramResult::first_error_line() const {
    return error.substr(0, error.find('\n'));
}

ProgramResult run_program_until(const std::vector<std::string>& words,
                                const std::filesystem::path& folder,
                                const std::function<bool()>& is_time, int signal) {
    const std::filesystem::path program =
        words.at(0).find('/') == std::string::npos
            ? std::filesystem::path(RELIEF_BIN_DIRECTORY) / words[0]
            : std::filesystem::path(words[0]);
    std::vector<std::string> copies = words;
    std::vector<char*> arguments;
    for (std::string& word : copies)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);

    const TemporaryDirectory streams;
    SpawnActions actions;
    actions.redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
    actions.redirect(STDOUT_FILENO, streams / "out", O_WRONLY | O_CREAT);
    actions.redirect(STDERR_FILENO, streams / "error", O_WRONLY | O_CREAT);
    actions.change_folder(folder);
    pid_t child = 0;
    const int failed =
        posix_spawn(&child, program.c_str(), actions.get(), nullptr, arguments.data(), environ);
    if (failed != 0) throw std::runtime_error(fmt::format("{} cannot be run", program.string()));
    const int exit_code = exit_code_of(child, is_time, signal);
    return {exit_code, contents_of(streams / "out"), contents_of(streams / "error")};
}

ProgramResult run_program(const std::vector<std::string>& words,
                          const std::filesystem::path& folder) {
    return run_program_until(words, folder, nullptr, 0);
}

ProgramResult run_shell(const std::string& line, const std::filesystem::path& folder) {
    const std::string script = fmt::format("PATH='{}':\"$PATH\"\n{}", RELIEF_BIN_DIRECTORY, line);
    return run_program({"/bin/sh", "-c", script}, folder);
}

ProgramResult run_line(const std::string& line, const std::filesystem::path& folder) {
    const std::optional<std::vector<std::string>> words = plain_text(line);
    if (words) {
        const auto linked = linked_tools().find(std::filesystem::path((*words)[0]).filename());
        if (linked != linked_tools().end()) return run_linked(linked->second, *words, folder);
    }
    return run_shell(line, folder);
}

}  // namespace relief::test
