// SPDX-License-Identifier: Apache-2.0
// Tests: tests/check/check_fix_test.cpp.
#include "check_fix.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/command.h"
#include "common/options.h"
#include "driver.h"

extern char** environ;

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// Returns the words of a remedy with the names of the files.
std::vector<std::string> words_of(std::string_view remedy, const fs::path& input,
                                  const fs::path& output) {
    std::vector<std::string> words = split(remedy, ' ');
    for (std::string& word : words) {
        if (word == "IN") word = as_argument(input).string();
        if (word == "OUT") word = as_argument(output).string();
    }
    words.emplace_back("--quiet");
    return words;
}

/// Returns everything that can be read from a pipe.
std::string text_of_pipe(int descriptor) {
    std::string text;
    char part[4096];
    while (true) {
        const ssize_t count = ::read(descriptor, part, sizeof part);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return text;
        text.append(part, static_cast<std::size_t>(count));
    }
}

/// Runs a tool of relief. \return its first message, or a reason; empty if it succeeded
std::string run(const std::vector<std::string>& words) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return std::strerror(errno);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<std::string> own = words;
    std::vector<char*> arguments;
    for (std::string& word : own)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const fs::path program = sibling_program(words.front());
    pid_t process = 0;
    const int failure =
        ::posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    const std::string message = failure == 0 ? text_of_pipe(ends[0]) : "";
    ::close(ends[0]);
    if (failure != 0) return fmt::format("{}: {}", words.front(), std::strerror(failure));
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
    const std::string line = message.substr(0, message.find('\n'));
    return line.empty() ? fmt::format("{} failed", words.front()) : line;
}

/// Returns the remedies of a file, repairs of triangles first: they change normals and tangents.
std::vector<std::string_view> remedies_of(const CheckedItem& item) {
    const auto rank = [](std::string_view remedy) {
        return std::pair(!remedy.starts_with("relief-mesh repair"), remedy);
    };
    std::vector<std::string_view> remedies;
    for (const CheckFinding& finding : item.findings) {
        const std::string_view remedy = finding.rule->remedy;
        const bool is_new = std::ranges::find(remedies, remedy) == remedies.end();
        if (finding.is_fixable && finding.severity >= CheckSeverity::warning && is_new)
            remedies.push_back(remedy);
    }
    std::ranges::sort(remedies, {}, rank);
    return remedies;
}

/// Returns the name of a copy: that of the file, without what leads out of the folder.
fs::path copy_of(const fs::path& file, const fs::path& folder) {
    fs::path inside;
    for (const fs::path& part : file.lexically_normal().relative_path()) {
        if (part != "..") inside /= part;
    }
    return folder / inside;
}

/// Runs the remedies one after another on the output of the one before.
CheckFix fix(const CheckedItem& item, const std::optional<fs::path>& folder) {
    CheckFix done{item.file, folder ? copy_of(item.file, *folder) : item.file, "", ""};
    try {
        if (folder) make_folder(done.output.parent_path());
    } catch (const Error& error) {
        done.error = error.what();
        return done;
    }
    fs::path input = item.file;
    for (const std::string_view remedy : remedies_of(item)) {
        if (!done.command.empty()) done.command += "; ";
        done.command += remedy;
        done.error = run(words_of(remedy, input, done.output));
        if (!done.error.empty()) return done;
        input = done.output;
    }
    return done;
}

}  // namespace

std::vector<CheckFix> fix_files(const std::vector<CheckedItem>& items,
                                const std::optional<fs::path>& folder) {
    std::vector<CheckFix> fixes;
    for (const CheckedItem& item : items) {
        if (!remedies_of(item).empty()) fixes.push_back(fix(item, folder));
    }
    return fixes;
}

}  // namespace relief::tools
