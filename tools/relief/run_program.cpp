// SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

extern char** environ;

namespace relief::tools {
namespace {

/// Returns everything that can be read from a pipe.
std::string text_of_pipe(int descriptor) {
    std::string text;
    std::array<char, 4096> block{};
    while (true) {
        const ::ssize_t size = ::read(descriptor, block.data(), block.size());
        if (size < 0 && errno == EINTR) continue;
        if (size <= 0) return text;
        text.append(block.data(), static_cast<std::size_t>(size));
    }
}

}  // namespace

ProgramOutput run_program(const std::vector<std::string>& words, CapturedStream captured) {
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
    const auto start = std::chrono::steady_clock::now();
    ::pid_t child = 0;
    const int error =
        ::posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    ProgramOutput output;
    if (error == 0) output.text = text_of_pipe(ends[0]);
    ::close(ends[0]);
    if (error != 0) return {127, std::strerror(error), 0.0, 0};
    int status = 0;
    ::rusage use{};
    while (::wait4(child, &status, 0, &use) < 0 && errno == EINTR) {
    }
    output.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    output.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    output.peak_bytes = static_cast<std::uint64_t>(use.ru_maxrss) * 1024;
    return output;
}

}  // namespace relief::tools
