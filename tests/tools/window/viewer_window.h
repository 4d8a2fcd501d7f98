// SPDX-License-Identifier: Apache-2.0
/// \file
/// relief-view's window on a display, driven by xdotool, seen through --dump-state and the screen.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/window/display.h"
#include "tools/workplace.h"

namespace relief::test {

class ViewerWindow {
  public:
    /// Opens it as `relief-view WORDS --dump-state FILE` in that folder, and waits for its first
    /// words about itself.
    ///
    /// \param environment  "NAME=VALUE ..." beside the display
    ViewerWindow(const Display& display, const Workplace& workplace, const std::string& words,
                 const std::string& environment = "");

    /// What it says of itself now.
    [[nodiscard]] nlohmann::json state() const;

    using Condition = std::function<bool(const nlohmann::json&)>;
    /// Waits until it says so and rests. \return what it then says; fails the test if it never does
    nlohmann::json wait_for(const std::string& what, const Condition& holds);
    /// Waits until nothing is read or drawn any more.
    nlohmann::json wait_for_rest();

    void key(const std::string& name) const { display_.act("key " + name); }
    /// Presses a button at a place, moves on by so much in small steps, lets go.
    void drag(int x, int y, int dx, int dy, int button = 1) const;
    /// Moves the pointer there, and waits until the program has noticed.
    void point_at(int x, int y) const;
    void click(int x, int y) const;
    /// Clicks on what the state's "places" names, once it is there and stays.
    void click_on(const std::string& name) const;

    ChildProcess& process() { return *process_; }
    [[nodiscard]] std::string said() const { return contents_of(streams_ / "error"); }

  private:
    const Display& display_;
    TemporaryDirectory streams_;
    std::unique_ptr<ChildProcess> process_;
};

/// Whether a state lists this effect.
bool has_effect(const nlohmann::json& state, const char* effect);

/// The view on a screen, which ends at its right and begins at its top. \param view  "view" of the
/// state
Image view_on(const Image& screen, const nlohmann::json& view);

/// The parts of two pictures of one size that differ by more than so many codes, from 0 to 1,
/// within a rectangle.
double changed_share(const Image& before, const Image& after, int x, int y, int width, int height,
                     int codes = 8);

/// The same of the part of the screen that is surely picture, in the middle of the view.
double changed_picture(const Image& before, const Image& after);

/// Seconds of processor time that a process has used.
double processor_seconds(pid_t pid);

}  // namespace relief::test
