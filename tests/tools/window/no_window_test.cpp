// SPDX-License-Identifier: Apache-2.0
// Without a display: a window reports what is missing, and pictures never connect to a display. The
// tests listen on the socket of a display, to which GLFW would connect first.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <cstring>
#include <string>
#include <thread>

#include "support/labels.h"
#include "tools/workplace.h"

namespace relief::tools {
namespace {

FILE_LABELS(cli);

using test::ProgramResult;
using test::Workplace;
using testing::HasSubstr;

/// Listens as display `name()`, and closes each connection.
class ListeningDisplay {
  public:
    ListeningDisplay() {
        socket_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
        // The first free number that no display uses.
        for (number_ = 5000; number_ < 5100 && !is_listening_; ++number_)
            is_listening_ = listens_at(fmt::format("/{}/.X11-unix/X{}", "tmp", number_));
        --number_;
        thread_ = std::thread([this] { listen(); });
    }
    ~ListeningDisplay() {
        is_ending_ = true;
        thread_.join();
        ::close(socket_);
    }
    ListeningDisplay(const ListeningDisplay&) = delete;
    ListeningDisplay& operator=(const ListeningDisplay&) = delete;

    [[nodiscard]] bool is_listening() const { return is_listening_; }
    [[nodiscard]] std::string name() const { return fmt::format(":{}", number_); }

    /// Returns whether any program has connected.
    [[nodiscard]] bool was_called() const { return was_called_; }

  private:
    /// Uses an abstract address, which has no file. Clients try it first.
    [[nodiscard]] bool listens_at(const std::string& path) const {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(&address.sun_path[1], path.data(), path.size());
        const std::size_t length = offsetof(sockaddr_un, sun_path) + 1 + path.size();
        return ::bind(socket_, reinterpret_cast<const sockaddr*>(&address),
                      static_cast<socklen_t>(length)) == 0 &&
               ::listen(socket_, 16) == 0;
    }

    void listen() {
        while (!is_ending_) {
            pollfd waiting{socket_, POLLIN, 0};
            if (::poll(&waiting, 1, 20) <= 0) continue;
            was_called_ = true;
            ::close(::accept(socket_, nullptr, nullptr));
        }
    }

    std::atomic<bool> is_ending_ = false;
    std::atomic<bool> was_called_ = false;
    std::thread thread_;
    int socket_ = -1;
    int number_ = 0;
    bool is_listening_ = false;
};

TEST(NoWindow, PicturesNeedNoDisplay) {
    const Workplace workplace;
    const ListeningDisplay display;
    ASSERT_TRUE(display.is_listening());
    const std::string environment = "DISPLAY=" + display.name() + " WAYLAND_DISPLAY=no-such ";
    for (const char* words : {"relief-view data/vase.obj --output out/vase.png --size 64x64",
                              "relief-view data/vase.obj --explain-effects",
                              "relief-view --list-bindings", "relief-view --help"}) {
        const ProgramResult result = workplace.run(environment + words);
        EXPECT_EQ(result.exit_code, 0) << words << "\n" << result.error;
        EXPECT_FALSE(display.was_called()) << words;
    }
    EXPECT_EQ(workplace.outputs(), "vase.png");
}

TEST(NoWindow, WindowReportsAMissingDisplay) {
    const Workplace workplace;
    const ListeningDisplay display;
    ASSERT_TRUE(display.is_listening());
    const ProgramResult result =
        workplace.run("DISPLAY=" + display.name() + " relief-view data/vase.obj");
    EXPECT_TRUE(display.was_called()) << "or nobody would be heard at all";
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.error, HasSubstr("no window can be opened"));
    EXPECT_THAT(result.error, HasSubstr(display.name()));
    EXPECT_THAT(result.error, HasSubstr("--output FILE.png"));
}

TEST(NoWindow, BackendIsRejectedForAWindow) {
    const Workplace workplace;
    const ProgramResult result = workplace.run("relief-view data/vase.obj --backend osmesa");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.first_error_line(),
              "relief-view: error: --backend: applies to pictures; the window uses the OpenGL of "
              "its display (add --output, or leave it out)");
}

TEST(NoWindow, WithoutADisplayTheMessageNamesOutput) {
    const Workplace workplace;
    const ProgramResult result =
        workplace.run("env -u DISPLAY -u WAYLAND_DISPLAY relief-view data/vase.obj");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(
        result.first_error_line(),
        "relief-view: error: no window can be opened: X11: The DISPLAY environment variable is "
        "missing (pictures need no display: --output FILE.png)");
}

}  // namespace
}  // namespace relief::tools
