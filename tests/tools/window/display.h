// SPDX-License-Identifier: Apache-2.0
/// \file
/// A screen without a screen: Xvfb, which keeps its pixels in a file that can be read.
/// 1280 x 800 pixels of 24 bits.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>

#include "relief/mesh/image.h"
#include "support/shared_data.h"

namespace relief::test {

/// A child process; ended with the object.
class ChildProcess {
  public:
    ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& streams);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Waits for its own end. \return the exit code; -1 if it goes on for longer than so long
    int wait_for_end(double seconds);
    [[nodiscard]] bool has_ended();

  private:
    pid_t pid_ = 0;
    int status_ = 0;
    bool has_ended_ = false;
};

class Display {
  public:
    /// The one of this process, with the pointer in its lower left corner. Null if Xvfb or xdotool
    /// is not installed.
    static const Display* of_process();

    [[nodiscard]] const std::string& name() const { return name_; }  ///< ":1234"

    /// What is on the screen now, 8-bit RGB: half of a frame, where one is just being put there.
    [[nodiscard]] Image picture() const;
    /// The same once it stays as it is: a window tells its state before its frame is on the screen.
    [[nodiscard]] Image resting_picture() const;

    /// Runs xdotool there. \throws std::runtime_error if it fails
    void act(const std::string& words) const;

  private:
    Display() = default;
    static std::unique_ptr<Display> open();

    TemporaryDirectory folder_;
    std::unique_ptr<ChildProcess> server_;
    std::string name_;
};

/// Waits until something holds, looking often. \return whether it did within so many seconds
template <typename Condition>
bool eventually(const Condition& holds, double seconds = 100.0);

/// Sleeps a little, between two looks.
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

}  // namespace relief::test

/// The display of the process as `variable`; the test is skipped if there is none.
#define RELIEF_NEEDS_DISPLAY(variable)                                                 \
    const relief::test::Display* const variable = relief::test::Display::of_process(); \
    if (variable == nullptr) GTEST_SKIP() << "needs Xvfb and xdotool"
