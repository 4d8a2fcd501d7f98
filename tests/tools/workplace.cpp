// SPDX-License-Identifier: Apache-2.0
#include "tools/workplace.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "relief/mesh/image_file.h"
#include "support/shared_data.h"
#include "tools/linked_tools.h"

namespace relief::test {
namespace {

std::string contents_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The targets of the child's standard streams, and its working directory.
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

namespace fs = std::filesystem;

Workplace::Workplace() {
    fs::create_directory(folder_ / "out");
    fs::create_directory(folder_ / "build");
    fs::create_directory_symlink(source_directory() / "data", folder_ / "data");
    fs::create_directory_symlink(source_directory() / "conformance", folder_ / "conformance");
    fs::create_directory_symlink(source_directory() / "scripts", folder_ / "scripts");
    fs::create_directory_symlink(RELIEF_BUILD_DIRECTORY, folder_ / "build/release");
}

ProgramResult Workplace::run(const std::string& line) const {
    return run_line(line, folder_.path());
}

void Workplace::write(const fs::path& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Workplace::read(const fs::path& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void Workplace::write_square(const fs::path& name, bool plain) const {
    const std::string positions = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
    write(name, plain ? positions + "f 1 2 3\nf 1 3 4\n"
                      : positions +
                            "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                            "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
}

void Workplace::write_bricks(const fs::path& name) const {
    constexpr int side = 256;
    const Image whole = read_image(source_directory() / "data/bricks-height.png", ImageUse::data);
    Image part = make_image(side, side, 1, 16, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        const auto row = whole.as<std::uint16_t>().subspan(
            static_cast<std::size_t>(y) * static_cast<std::size_t>(whole.width), side);
        std::copy(row.begin(), row.end(), part.as<std::uint16_t>().begin() + y * side);
    }
    write_image(folder_ / name, part);
}

void Workplace::shrink_bricks() const {
    fs::remove(folder_ / "data");
    fs::create_directory(folder_ / "data");
    for (const auto& entry : fs::directory_iterator(source_directory() / "data")) {
        const fs::path name = entry.path().filename();
        if (name != "bricks-height.png") fs::create_symlink(entry.path(), folder_ / "data" / name);
    }
    write_bricks("data/bricks-height.png");
}

std::string Workplace::outputs() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "out"))
        names.insert(entry.path().filename().string());
    std::string list;
    for (const std::string& name : names)
        list += (list.empty() ? "" : " ") + name;
    return list;
}

void expect_refusal(const Workplace& workplace, const std::string& tool, const Refused& refused,
                    const std::string& old_file) {
    const std::string line =
        refused.line.starts_with(tool) ? refused.line : tool + " " + refused.line;
    SCOPED_TRACE(line);
    std::filesystem::remove_all(workplace / "out");
    std::filesystem::create_directory(workplace / "out");
    workplace.write("out/" + old_file, "old");
    const ProgramResult result = workplace.run(line);
    EXPECT_EQ(result.exit_code, refused.exit_code);
    EXPECT_THAT(result.first_error_line(), testing::HasSubstr(tool + ": error: " + refused.error));
    EXPECT_EQ(result.error, result.first_error_line() + "\n");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(workplace.outputs(), old_file);
    EXPECT_EQ(workplace.read("out/" + old_file), "old");
}

void expect_refusals(const Workplace& workplace, const std::string& tool,
                     const std::string& old_file, const std::vector<Refused>& rows) {
    for (const Refused& row : rows)
        expect_refusal(workplace, tool, row, old_file);
}

}  // namespace relief::test
