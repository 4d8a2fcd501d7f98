// SPDX-License-Identifier: Apache-2.0
/// \file
/// A virtual display of 1280 x 800 pixels: Xvfb, whose pixels are in a file, and xdotool.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "support/shared_data.h"

namespace relief::test {

/// A child process, which ends with the object.
class ChildProcess {
  public:
    ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& streams);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Waits until the process ends.
    /// \return the exit code, or -1 after the timeout
    int wait_for_end(double seconds);
    [[nodiscard]] bool has_ended();

  private:
    pid_t pid_ = 0;
    int status_ = 0;
    bool has_ended_ = false;
};

class Display {
  public:
    /// The display of this process, with the pointer in the lower left corner. Null if Xvfb or
    /// xdotool is not installed.
    static const Display* of_process();

    [[nodiscard]] const std::string& name() const { return name_; }  ///< For example ":1234".

    /// The current screen as 8-bit RGB. It may contain a part of the next frame.
    [[nodiscard]] Image picture() const;
    /// The screen as soon as it is stable. The window reports its state before the frame is
    /// visible.
    [[nodiscard]] Image resting_picture() const;

    /// Runs xdotool on the display. \throws std::runtime_error if it fails
    void act(const std::string& words) const;

  private:
    Display() = default;
    static std::unique_ptr<Display> open();

    TemporaryDirectory folder_;
    std::unique_ptr<ChildProcess> server_;
    std::string name_;
};

/// Waits until a condition holds. \return whether it held before the timeout
template <typename Condition>
bool eventually(const Condition& holds, double seconds = 100.0);

/// Sleeps for the polling interval.
void pause_a_little();
void wait_seconds(double seconds);
double seconds_now();

template <typename Condition>
bool eventually(const Condition& holds, double seconds) {
    const double end = seconds_now() + seconds;
    while (!holds()) {
        if (seconds_now() > end) return false;
        pause_a_little();
    }
    return true;
}

std::string contents_of(const std::filesystem::path& file);

/// Drops files on the only window that accepts drops, at a position on the screen. The function
/// implements the source side of the XDND protocol, version 5 (freedesktop.org).
/// \return whether the window accepted the files
bool drop_files(const std::string& display, const std::vector<std::filesystem::path>& files, int x,
                int y);

}  // namespace relief::test

/// Defines `variable` as the display of the process. Without a display, the test is skipped.
#define RELIEF_NEEDS_DISPLAY(variable)                                                 \
    const relief::test::Display* const variable = relief::test::Display::of_process(); \
    if (variable == nullptr) GTEST_SKIP() << "needs Xvfb and xdotool"
