// SPDX-License-Identifier: Apache-2.0
#include "tools/window/viewer_window.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace relief::test {

ViewerWindow::ViewerWindow(const Display& display, const Workplace& workplace,
                           const std::string& words, const std::string& environment)
    : display_(display) {
    // The hint of the first run and the axes would cover a part of the picture.
    std::filesystem::create_directories(streams_ / "xdg/relief");
    std::ofstream(streams_ / "xdg/relief/relief-view.json")
        << R"({"version": 1, "hint_seen": true, "axes": false})";
    // exec replaces the shell, so that the processor time of the program can be measured.
    // LeakSanitizer is off, because Mesa's driver is unloaded before its leaks can be symbolized.
    const std::string line = fmt::format(
        "cd {} && DISPLAY={} XDG_STATE_HOME={} ASAN_OPTIONS=detect_leaks=0 {} exec "
        "build/release/bin/relief-view {} "
        "--dump-state {}",
        (workplace / "").string(), display.name(), (streams_ / "xdg").string(), environment, words,
        (streams_ / "state.json").string());
    process_ = std::make_unique<ChildProcess>(std::vector<std::string>{"/bin/sh", "-c", line},
                                              streams_.path());
    const auto has_begun = [&] {
        return std::filesystem::exists(streams_ / "state.json") || process_->has_ended();
    };
    EXPECT_TRUE(eventually(has_begun)) << error_output();
    EXPECT_FALSE(process_->has_ended()) << error_output();
}

nlohmann::json ViewerWindow::state() const {
    const std::string text = contents_of(streams_ / "state.json");
    return text.empty() ? nlohmann::json::object() : nlohmann::json::parse(text);
}

nlohmann::json ViewerWindow::wait_for(const std::string& what, const Condition& holds) {
    nlohmann::json now;
    const auto is_so = [&] {
        if (process_->has_ended()) return true;
        now = state();
        return !now.value("loading", true) && !now.value("busy", true) && holds(now);
    };
    EXPECT_TRUE(eventually(is_so)) << "never: " << what << "\n" << now.dump(2) << error_output();
    EXPECT_FALSE(process_->has_ended()) << what << "\n" << error_output();
    return now;
}

nlohmann::json ViewerWindow::wait_for_rest() {
    return wait_for("rest", [](const nlohmann::json& now) {
        return now["revision"] > 0 && now["drawn"]["revision"] == now["revision"];
    });
}

void ViewerWindow::drag(int x, int y, int dx, int dy, int button) const {
    point_at(x, y);
    std::string words = fmt::format("mousedown {}", button);
    for (int i = 0; i < 10; ++i)
        words += fmt::format(" mousemove {} {}", x + dx * (i + 1) / 10, y + dy * (i + 1) / 10);
    display_.act(words);
    // A window that handled the press together with later movements would take it for a click
    // there.
    wait_for_pointer(x + dx, y + dy);
    display_.act(fmt::format("mouseup {}", button));
}

void ViewerWindow::wait_for_pointer(int x, int y) const {
    nlohmann::json now;
    const auto is_there = [&] {
        now = state();
        return now["pointer"] == nlohmann::json({x, y});
    };
    EXPECT_TRUE(eventually(is_there)) << "the pointer is at " << now["pointer"];
}

void ViewerWindow::point_at(int x, int y) const {
    display_.act(fmt::format("mousemove {} {}", x, y));
    wait_for_pointer(x, y);
}

void ViewerWindow::click(int x, int y) const {
    point_at(x, y);
    display_.act("click 1");
}

void ViewerWindow::click_on(const std::string& name) const {
    const auto place = [&] { return state()["places"].value(name, nlohmann::json()); };
    const auto is_pointed_at = [&] {  // Items above may still appear and move it.
        const nlohmann::json before = place();
        if (before.is_null()) return false;
        point_at(before[0].get<int>(), before[1].get<int>());
        return place() == before;
    };
    ASSERT_TRUE(eventually(is_pointed_at)) << name << " is not there";
    display_.act("click 1");
}

bool has_effect(const nlohmann::json& state, const char* effect) {
    const nlohmann::json effects = state.value("effects", nlohmann::json::array());
    return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

Image view_on(const Image& screen, const nlohmann::json& view) {
    const int width = view[0].get<int>();
    const int height = view[1].get<int>();
    Image part = make_image(width, height, 3, 8, ColorSpace::srgb);
    const std::span<const std::uint8_t> from = screen.as<std::uint8_t>();
    auto& to = std::get<std::vector<std::uint8_t>>(part.samples);
    for (int row = 0; row < height; ++row) {
        const auto begin = from.begin() + 3 * (row * screen.width + screen.width - width);
        std::copy_n(begin, 3 * width, to.begin() + 3 * row * width);
    }
    return part;
}

double changed_share(const Image& before, const Image& after, int x, int y, int width, int height,
                     int codes) {
    const std::span<const std::uint8_t> a = before.as<std::uint8_t>();
    const std::span<const std::uint8_t> b = after.as<std::uint8_t>();
    int changed = 0;
    for (int row = y; row < y + height; ++row) {
        for (int column = x; column < x + width; ++column) {
            const auto at = static_cast<std::size_t>(3 * (row * before.width + column));
            int worst = 0;
            for (std::size_t channel = 0; channel < 3; ++channel)
                worst = std::max(worst, std::abs(a[at + channel] - b[at + channel]));
            changed += worst > codes ? 1 : 0;
        }
    }
    return static_cast<double>(changed) / (width * height);
}

double changed_picture(const Image& before, const Image& after) {
    return changed_share(before, after, 600, 200, 400, 400);
}

double processor_seconds(pid_t pid) {
    clockid_t clock{};
    timespec time{};
    if (::clock_getcpuclockid(pid, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
        throw std::runtime_error("no processor time of process " + std::to_string(pid));
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace relief::test
