// SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

extern char** environ;

namespace relief::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// Waits until a pipe has bytes or is closed. \return false at the end of the time
bool is_ready(int descriptor, const std::optional<Clock::time_point>& end) {
    while (end) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(*end - Clock::now()).count();
        if (left <= 0) return false;
        ::pollfd request{descriptor, POLLIN, 0};
        constexpr std::int64_t longest = 60'000;
        const int events = ::poll(&request, 1, static_cast<int>(std::min(left, longest)));
        if (events > 0) return true;
        if (events < 0 && errno != EINTR) return true;
    }
    return true;
}

/// Reads a pipe to its end. \return false if the time ended before
bool read_pipe(int descriptor, const std::optional<Clock::time_point>& end, std::string& text) {
    std::array<char, 4096> block{};
    while (is_ready(descriptor, end)) {
        const ::ssize_t size = ::read(descriptor, block.data(), block.size());
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) return true;
        text.append(block.data(), static_cast<std::size_t>(size));
    }
    return false;
}

}  // namespace

ProgramOutput run_program(const std::vector<std::string>& words, CapturedStream captured,
                          std::optional<double> limit) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {127, std::strerror(errno), 0.0, 0};
    std::vector<std::string> own = words;
    std::vector<char*> arguments;
    for (std::string& word : own)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (captured == CapturedStream::errors)
        ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(
        &actions, ends[1], captured == CapturedStream::errors ? STDERR_FILENO : STDOUT_FILENO);
    const auto start = Clock::now();
    std::optional<Clock::time_point> end;
    if (limit) end = start + std::chrono::milliseconds(static_cast<std::int64_t>(*limit * 1000.0));
    ::pid_t child = 0;
    const int error =
        ::posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    ProgramOutput output;
    const bool has_ended = error != 0 || read_pipe(ends[0], end, output.text);
    ::close(ends[0]);
    if (error != 0) return {127, std::strerror(error), 0.0, 0};
    if (!has_ended) ::kill(child, SIGKILL);
    int status = 0;
    ::rusage use{};
    while (::wait4(child, &status, 0, &use) < 0 && errno == EINTR) {
    }
    output.exit_code = !has_ended          ? ProgramOutput::timed_out
                       : WIFEXITED(status) ? WEXITSTATUS(status)
                                           : 128 + WTERMSIG(status);
    output.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    output.peak_bytes = static_cast<std::uint64_t>(use.ru_maxrss) * 1024;
    return output;
}

}  // namespace relief::tools
