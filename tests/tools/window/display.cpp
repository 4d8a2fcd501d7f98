// SPDX-License-Identifier: Apache-2.0
// Xvfb writes its screen to a file in the XWD format (X11/XWDFile.h): a header of big-endian words,
// color maps, and rows of pixels.
#include "tools/window/display.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/workplace.h"

namespace relief::test {
namespace {

bool is_installed(const char* program) {
    return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

/// A word of the header.
std::uint32_t word(const std::string& bytes, std::size_t index) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8U | static_cast<unsigned char>(bytes.at(4 * index + i));
    return value;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& words,
                           const std::filesystem::path& streams) {
    std::vector<std::string> copies = words;
    std::vector<char*> arguments;
    for (std::string& text : copies)
        arguments.push_back(text.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const auto redirect = [&](int stream, const std::filesystem::path& file, int flags) {
        posix_spawn_file_actions_addopen(&actions, stream, file.c_str(), flags, 0600);
    };
    redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
    redirect(STDOUT_FILENO, streams / "out", O_WRONLY | O_CREAT);
    redirect(STDERR_FILENO, streams / "error", O_WRONLY | O_CREAT);
    const int failed =
        posix_spawnp(&pid_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error(words[0] + " cannot be run");
}

ChildProcess::~ChildProcess() {
    if (has_ended()) return;
    ::kill(pid_, SIGTERM);
    if (wait_for_end(10.0) >= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
}

bool ChildProcess::has_ended() {
    if (!has_ended_) has_ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
    return has_ended_;
}

int ChildProcess::wait_for_end(double seconds) {
    if (!eventually([&] { return has_ended(); }, seconds)) return -1;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

const Display* Display::of_process() {
    static const std::unique_ptr<Display> display = open();
    if (display) display->act("mouseup 1 mouseup 2 mouseup 3 mousemove 5 795");
    return display.get();
}

std::unique_ptr<Display> Display::open() {
    if (!is_installed("Xvfb") || !is_installed("xdotool")) return nullptr;
    std::unique_ptr<Display> display(new Display);
    std::filesystem::create_directory(display->folder_ / "streams");
    // Xvfb writes the number of the display to standard output.
    display->server_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{"Xvfb", "-displayfd", "1", "-screen", "0", "1280x800x24",
                                 "-nolisten", "tcp", "-noreset", "-fbdir",
                                 display->folder_.path().string()},
        display->folder_ / "streams");
    const auto output = [&] { return contents_of(display->folder_ / "streams" / "out"); };
    if (!eventually([&] { return output().ends_with('\n'); }))
        throw std::runtime_error("Xvfb does not start");
    const std::string number = output();
    display->name_ = fmt::format(":{}", number.substr(0, number.find('\n')));
    return display;
}

Image Display::picture() const {
    const std::string bytes = contents_of(folder_ / "Xvfb_screen0");
    const std::size_t begin = word(bytes, 0) + 12 * word(bytes, 19);  // Header and color map.
    const int width = static_cast<int>(word(bytes, 4));
    const int height = static_cast<int>(word(bytes, 5));
    const std::size_t stride = word(bytes, 12);
    if (word(bytes, 11) != 32) throw std::runtime_error("not a screen of 32-bit pixels");
    Image image = make_image(width, height, 3, 8, ColorSpace::srgb);
    const std::span<std::uint8_t> samples = image.as<std::uint8_t>();
    std::size_t next = 0;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
            const std::size_t pixel = begin + y * stride + 4 * x;  // Blue, green, red, unused.
            for (const std::size_t channel : {2U, 1U, 0U})
                samples[next++] = static_cast<std::uint8_t>(bytes.at(pixel + channel));
        }
    }
    return image;
}

Image Display::resting_picture() const {
    Image last = picture();
    const auto stays = [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        const Image before = std::exchange(last, picture());
        return before.samples == last.samples;
    };
    if (!eventually(stays)) throw std::runtime_error("the screen does not come to rest");
    return last;
}

void Display::act(const std::string& words) const {
    const ProgramResult result =
        run_line(fmt::format("DISPLAY={} xdotool {}", name_, words), folder_.path());
    if (result.exit_code != 0) throw std::runtime_error("xdotool " + words + ": " + result.error);
}

void pause_a_little() {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

void wait_seconds(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::string contents_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace relief::test
