// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/window_test.cpp.
#include "window/window_loop.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <chrono>

#include "file_replacement.h"
#include "window/dropped_files.h"
#include "window/places.h"
#include "window/user_interface.h"

namespace relief::tools {
namespace {

constexpr glm::ivec2 usual_size{1280, 800};
constexpr int frames_to_settle = 3;  // Dear ImGui reacts to what it drew a frame ago.
constexpr double turning_step = 1.0 / 60.0;
constexpr double loading_step = 0.1;  // Seconds between looks at the clock while reading.

class WindowLoop {
  public:
    explicit WindowLoop(const ViewOptions& options)
        : system_("relief-view", usual_size),
          drawer_({[this] { system_.use_worker_context(); },
                   [this] { system_.release_worker_context(); }, WindowSystem::loader(),
                   WindowSystem::wake}),
          loader_(WindowSystem::wake),
          interface_(system_),
          state_(options),
          dump_(options.dump_state) {
        if (dump_) keep_places();
        if (!options.model.empty()) loader_.start(options);
    }

    void run() {
        while (!system_.is_closing()) {
            wait();
            if (std::optional<Loaded> loaded = loader_.take()) state_.take(std::move(*loaded));
            state_.pass(seconds_since_last());
            if (system_.is_visible()) draw();
        }
    }

  private:
    /// Sleeps unless something is going on.
    void wait() {
        if (settling_ > 0) {
            --settling_;
            glfwPollEvents();
            return;
        }
        if (state_.is_turning()) {
            WindowSystem::wait(turning_step);
        } else {
            WindowSystem::wait(loader_.is_loading() ? loading_step : 0.0);
            settling_ = frames_to_settle - 1;
        }
    }

    double seconds_since_last() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return std::min(seconds, 0.1);  // After a sleep, nothing leaps.
    }

    void draw() {
        // Asked first: not busy now means that what comes next is the newest.
        const bool was_busy = drawer_.is_busy();
        const DrawnPicture drawn = drawer_.drawn();
        const PanelInput input{state_, drawn, drawer_.renderer_name(),
                               loader_.is_loading() ? loader_.seconds_so_far() : 0.0};
        const UserInterface::Events events = interface_.draw(input, drawer_.shown());
        if (events.panels.cancel_loading) loader_.cancel();
        for (const Action action : events.actions)
            act(action);
        for (const std::filesystem::path& file : events.dropped)
            loader_.start(with_dropped(state_.options(), file));
        const bool is_busy = request() || was_busy;
        dump(drawn, is_busy);
    }

    void act(Action action) {
        if (action == Action::help) interface_.show_help();
        if (action == Action::panels) interface_.show_panels();
        if (action == Action::quit) system_.close();
        if (action == Action::copy_camera)
            glfwSetClipboardString(system_.window(), state_.command_line().c_str());
    }

    /// Asks for a picture where the last one asked for shows something else. \return whether it did
    bool request() {
        const std::optional<DrawWish> wish = state_.wish();
        if (!wish) return false;
        const bool is_same = wished_ && wished_->revision == wish->revision &&
                             wished_->camera.world_from_view == wish->camera.world_from_view &&
                             wished_->camera.vertical_fov == wish->camera.vertical_fov &&
                             wished_->settings.width == wish->settings.width &&
                             wished_->settings.height == wish->settings.height;
        if (is_same) return false;
        wished_ = wish;
        drawer_.wish(*wish);
        return true;
    }

    /// Tests and scripts see what the window sees.
    void dump(const DrawnPicture& drawn, bool is_busy) {
        if (!dump_) return;
        nlohmann::ordered_json json = state_.json(drawn);
        json["loading"] = loader_.is_loading();
        json["busy"] = is_busy;
        json["help"] = interface_.is_help_open();
        json["places"] = places_json();
        const std::string text = json.dump(2) + "\n";
        if (text == dumped_) return;
        dumped_ = text;
        replace_file(*dump_, std::as_bytes(std::span(text)));
    }

    WindowSystem system_;
    DrawThread drawer_;
    Loader loader_;
    UserInterface interface_;
    ViewerState state_;
    std::optional<std::filesystem::path> dump_;
    std::string dumped_;
    std::optional<DrawWish> wished_;
    int settling_ = frames_to_settle;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

ExitCode run_window(const ViewOptions& options) {
    WindowLoop(options).run();
    return ExitCode::done;
}

}  // namespace relief::tools
