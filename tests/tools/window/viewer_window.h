// SPDX-License-Identifier: Apache-2.0
/// \file
/// The window of relief-view on a virtual display. Tests read its --dump-state file and the screen.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/window/display.h"
#include "tools/workplace.h"

namespace relief::test {

class ViewerWindow {
  public:
    /// Runs `relief-view WORDS --dump-state FILE` in that folder, and waits for the first state.
    ///
    /// \param environment  additional variables, "NAME=VALUE ..."
    ViewerWindow(const Display& display, const Workplace& workplace, const std::string& words,
                 const std::string& environment = "");

    /// The last state that the program has written.
    [[nodiscard]] nlohmann::json state() const;

    using Condition = std::function<bool(const nlohmann::json&)>;
    /// Waits until the program is idle and the condition holds. The test fails after a timeout.
    /// \return the state
    nlohmann::json wait_for(const std::string& what, const Condition& holds);
    /// Waits until nothing is being read or drawn.
    nlohmann::json wait_for_rest();

    void key(const std::string& name) const { display_.act("key " + name); }
    /// Drags the pointer in small steps. Waits until the program has noticed the press and the last
    /// step.
    void drag(int x, int y, int dx, int dy, int button = 1) const;
    /// Moves the pointer, and waits until the program has noticed.
    void point_at(int x, int y) const;
    void click(int x, int y) const;
    /// Clicks on an item of the state's "places" as soon as its position is stable.
    void click_on(const std::string& name) const;

    ChildProcess& process() { return *process_; }
    [[nodiscard]] std::string error_output() const { return contents_of(streams_ / "error"); }

  private:
    void wait_for_pointer(int x, int y) const;

    const Display& display_;
    TemporaryDirectory streams_;
    std::unique_ptr<ChildProcess> process_;
};

/// Returns whether a state contains this effect.
bool has_effect(const nlohmann::json& state, const char* effect);

/// The part of the screen that shows the view, at the upper right. \param view  "view" of the state
Image view_on(const Image& screen, const nlohmann::json& view);

/// The share of the pixels in a rectangle that differ by more than this many codes, from 0 to 1.
double changed_share(const Image& before, const Image& after, int x, int y, int width, int height,
                     int codes = 8);

/// changed_share() of a rectangle in the center of the view.
double changed_picture(const Image& before, const Image& after);

/// Processor time of a process in seconds.
double processor_seconds(pid_t pid);

}  // namespace relief::test
