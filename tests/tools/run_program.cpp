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
#include <stdexcept>

#include "support/shared_data.h"

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

}  // namespace

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

ProgramResult run_line(const std::string& line, const std::filesystem::path& folder) {
    const std::string script = fmt::format("PATH='{}':\"$PATH\"\n{}", RELIEF_BIN_DIRECTORY, line);
    return run_program({"/bin/sh", "-c", script}, folder);
}

}  // namespace relief::test
