// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/window_test.cpp.
#include "window/window_loop.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "common/command.h"
#include "file_replacement.h"
#include "window/comparison.h"
#include "window/dropped_files.h"
#include "window/followed_files.h"
#include "window/places.h"
#include "window/resolution.h"
#include "window/saving.h"
#include "window/scene_accuracy.h"
#include "window/user_interface.h"

namespace relief::tools {
namespace {

constexpr int frames_to_settle = 3;  // Dear ImGui reacts to what it drew a frame ago.
constexpr double turning_step = 1.0 / 60.0;
constexpr double loading_step = 0.1;  // Seconds between looks at how far reading is.

/// {"stage", "part": 0 to 1, or null where nobody knows}
nlohmann::ordered_json json_of(const Progress::State& progress) {
    return {{"stage", progress.stage},
            {"part", progress.part ? nlohmann::ordered_json(*progress.part) : nullptr}};
}

RememberedLayout remembered_layout(const ViewOptions& options) {
    const std::optional<std::filesystem::path> file = usual_layout_file();
    return options.no_state || !file ? RememberedLayout() : RememberedLayout(*file);
}

class WindowLoop {
  public:
    explicit WindowLoop(const ViewOptions& options)
        : remembered_(remembered_layout(options)),
          layout_(remembered_.layout()),
          system_("relief-view", layout_),
          drawer_({[this] { system_.use_worker_context(); },
                   [this] { system_.release_worker_context(); }, WindowSystem::loader(),
                   WindowSystem::wake}),
          loader_(WindowSystem::wake),
          health_(WindowSystem::wake),
          files_(WindowSystem::wake),
          interface_(system_),
          state_(options),
          comparison_(options.compare, WindowSystem::wake),
          accuracy_(WindowSystem::wake),
          saving_(WindowSystem::wake),
          reading_(options),
          ui_scale_(options.ui_scale),
          dump_(options.dump_state) {
        if (dump_) keep_places();
        if (options.size_given) asked_view_ = options.size;
        if (!options.model.empty()) loader_.start(reading_);
    }

    void run() {
        while (!system_.is_closing()) {
            wait();
            take_results();
            state_.pass(seconds_since_last());
            accuracy_.follow(state_);
            comparison_.follow(state_);
            saving_.follow();
            if (system_.is_visible()) draw();
        }
        // A size that an option asked for is for this time.
        if (!state_.options().size_given) system_.note_place(layout_);
        if (const std::string problem = remembered_.remember(layout_); !problem.empty())
            fmt::print(err(), "relief-view: warning: {}\n", problem);
    }

  private:
    /// What other threads have found since.
    void take_results() {
        if (std::optional<Loaded> loaded = loader_.take()) {
            files_.follow(*loaded);
            state_.take(std::move(*loaded));
            settling_ = frames_to_settle;
        }
        if (std::optional<HealthWish> wish = state_.take_health_wish())
            health_.start(std::move(*wish));
        if (std::optional<FoundHealth> found = health_.take()) state_.take(std::move(*found));
        take_changes(files_.take());
    }

    /// What files that changed make stale is made anew; the camera and edits stay.
    void take_changes(const FollowedFiles::Changed& changed) {
        if (changed.scene || changed.attempt) {
            // What was wanted last, if that is still to come.
            if (!loader_.is_loading() && !changed.attempt) reading_ = state_.options();
            loader_.start(reading_);
        }
        if (changed.picture) state_.refresh();
        if (changed.shaders) {
            drawer_.relink();
            wished_.reset();
            ++relinked_;
        }
    }

    /// Sleeps unless something is going on.
    void wait() {
        if (settling_ > 0) {
            --settling_;
            glfwPollEvents();
            return;
        }
        if (state_.is_turning()) {
            WindowSystem::wait(turning_step);
        } else if (is_resting_later_ && system_.is_visible()) {
            WindowSystem::wait(0.5 * Resolution::resting_seconds);
        } else {
            WindowSystem::wait(is_working() ? loading_step : 0.0);
            if (!is_working()) settling_ = frames_to_settle - 1;
        }
    }

    /// While something is read or drawn, a frame each step shows how far it is.
    bool is_working() {
        return loader_.is_loading() || drawer_.is_busy() || accuracy_.is_measuring() ||
               prices_.state().is_going_on || captured_->state().is_going_on();
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
        files_.follow(drawn);
        if (drawn.frames > 0 && !is_reduced(drawn.settings))
            resolution_.whole_took(drawn.times.draw);
        interface_.set_scale(scale());
        const PanelInput input{state_,
                               layout_,
                               drawn,
                               drawer_.renderer_name(),
                               loader_.seconds_so_far(),
                               reading_.model.filename().string(),
                               loader_.is_loading() ? loader_.progress() : drawer_.progress(),
                               was_busy || is_resting_later_,
                               &capture_settings_,
                               saved_text(),
                               remembered_.note(),
                               prices_,
                               shaders_,
                               &comparison_,
                               &accuracy_};
        const UserInterface::Events events = interface_.draw(input, drawer_.shown());
        // Whenever it came: while the panels settle after something else, too.
        if (events.has_input) settling_ = frames_to_settle;
        if (events.panels.cancel_loading) loader_.cancel();
        for (const Action action : events.actions)
            act(action);
        if (const auto view = std::exchange(asked_view_, std::nullopt))
            system_.grow(*view - state_.view());
        measure(drawn, events.panels);
        judge_methods(events.panels);
        if (events.panels.save_picture) save(0);
        if (events.panels.save_scene) saving_.save_scene(state_);
        if (events.panels.save_model) saving_.save_model(state_);
        if (events.panels.save_turn) save(capture_settings_.pictures);
        if (!events.dropped.empty()) drop(events.dropped);
        const bool is_busy = request() || was_busy || is_resting_later_ || health_.is_going_on();
        dump(drawn, is_busy || accuracy_.is_working() || comparison_.is_working() ||
                        saving_.is_going_on());
    }

    void act(Action action) {
        state_.act(action);
        if (action == Action::help) interface_.show_help();
        if (action == Action::panels) layout_.has_panels = !layout_.has_panels;
        if (action == Action::larger_interface)
            rescale(next_scale(interface_.scale().glyphs, true));
        if (action == Action::smaller_interface)
            rescale(next_scale(interface_.scale().glyphs, false));
        if (action == Action::usual_interface) rescale(std::nullopt);
        if (action == Action::quit) system_.close();
        if (action == Action::save_picture) save(0);
        if (action == Action::save_scene) saving_.save_scene(state_);
        if (action == Action::save_model) saving_.save_model(state_);
        if (action == Action::copy_camera)
            glfwSetClipboardString(system_.window(), command_line().c_str());
        if (action == Action::compare) comparison_.toggle();
        if (action == Action::swap_sides) comparison_.swap();
        if (action == Action::show_difference) comparison_.toggle_difference();
        if (action == Action::paste_camera) paste();
    }

    [[nodiscard]] std::string command_line() const {
        return state_.command_line() + comparison_.command_line();
    }

    void paste() {
        const char* text = glfwGetClipboardString(system_.window());
        state_.look_as(text == nullptr ? "" : text);
    }

    /// What was chosen here is remembered; the option holds until then, for this time only.
    void rescale(std::optional<float> scale) {
        ui_scale_.reset();
        layout_.ui_scale = scale;
    }
    [[nodiscard]] InterfaceScale scale() const {
        return interface_scale(ui_scale_ ? ui_scale_ : layout_.ui_scale, system_.content_scale(),
                               system_.pixels_to_unit());
    }

    /// Whether two wishes show the same, in whatever resolution.
    static bool is_same(const DrawWish& a, const DrawWish& b) {
        return a.revision == b.revision && a.camera.world_from_view == b.camera.world_from_view &&
               a.camera.vertical_fov == b.camera.vertical_fov && a.instead == b.instead &&
               a.beside.has_value() == b.beside.has_value() &&
               (!a.beside || a.beside->revision == b.beside->revision) &&
               a.settings.width == b.settings.width && a.settings.height == b.settings.height;
    }

    [[nodiscard]] bool is_reduced(const FrameSettings& settings) const {
        return settings.width < state_.view().x || settings.height < state_.view().y ||
               settings.samples < state_.options().samples;
    }

    void drop(const std::vector<std::filesystem::path>& files) {
        read_with([&](const ViewOptions& options) { return with_dropped(options, files); });
    }

    /// Reads with other options; what contradicts them is said like what cannot be read.
    template <typename Change>
    void read_with(const Change& change) {
        try {
            // On top of what is still being read.
            ViewOptions options = change(loader_.is_loading() ? reading_ : state_.options());
            options.debug = {};  // Chosen in the window, where nothing is a useless choice.
            settle(options);
            reading_ = options;
            loader_.start(options);
        } catch (const std::exception& error) {
            Loaded refused;
            refused.error = error.what();
            state_.take(std::move(refused));
        }
    }

    /// Figures for methods, and another method for the picture. A kernel is an option of what is
    /// read, which is how it stays with the height map when that changes.
    void judge_methods(const PanelWishes& wishes) {
        if (wishes.measure_accuracy) accuracy_.measure(state_);
        if (wishes.stop_accuracy) accuracy_.stop();
        if (!wishes.use_method) return;
        if (const Kernel* kernel = std::get_if<Kernel>(&*wishes.use_method)) {
            read_with([&](ViewOptions options) {
                options.kernel = *kernel;
                return options;
            });
        } else {
            accuracy_.use(*wishes.use_method);
        }
    }

    /// What effects cost, as long as they are those of the picture.
    void measure(const DrawnPicture& drawn, const PanelWishes& wishes) {
        const std::optional<DrawWish> wish = state_.wish();
        if (!wish || wishes.stop_measuring) return prices_.cancel();
        if (wishes.measure_effects) drawer_.add(prices_.start(*wish));
        if (drawn.plan && drawn.revision == wish->revision) prices_.keep_for(*drawn.plan, *wish);
    }

    /// One at a time; the panel and the status line say how far it is.
    void save(int turntable) {
        const std::optional<DrawWish> wish = state_.wish();
        if (!wish || captured_->state().is_going_on()) return;
        CaptureWish capture{.scene = wish->scene,
                            .effects = wish->effects,
                            .settings = wish->settings,
                            .camera = wish->camera,
                            .transparent = capture_settings_.transparent,
                            .turntable = turntable,
                            .middle = state_.ball().center,
                            .file = free_file(state_.options().model, turntable)};
        if (capture_settings_.own_size) {
            capture.settings.width = capture_settings_.width;
            capture.settings.height = capture_settings_.height;
        }
        drawer_.add(capture_task(std::move(capture), captured_));
    }

    /// What was saved last, in words: pictures, or scene and model.
    [[nodiscard]] std::string saved_text() const {
        const std::string pictures = text_of(captured_->state());
        return pictures.empty() || saving_.text().empty() ? pictures + saving_.text()
                                                          : pictures + "   " + saving_.text();
    }

    /// Asks for a picture where the last one asked for shows something else. \return whether it did
    bool request() {
        std::optional<DrawWish> wish = state_.wish();
        if (!wish) return false;
        if (std::optional<DrawTask> task = comparison_.add_to(*wish)) drawer_.add(std::move(*task));
        const bool is_moved = !wished_ || !is_same(*wished_, *wish);
        const double now = glfwGetTime();
        if (is_moved && wished_ && !wish->instead) resolution_.moved(now);
        DrawWish reduced = *wish;
        reduced.settings = resolution_.settings_for(wish->settings, now);
        is_resting_later_ = is_reduced(reduced.settings);
        const bool is_as_asked = asked_.width == reduced.settings.width &&
                                 asked_.height == reduced.settings.height &&
                                 asked_.samples == reduced.settings.samples;
        if (!is_moved && is_as_asked) return false;
        if (is_resting_later_) ++reduced_;
        wished_ = wish;
        asked_ = reduced.settings;
        drawer_.wish(std::move(reduced));
        return true;
    }

    /// Tests and scripts see what the window sees.
    void dump(const DrawnPicture& drawn, bool is_busy) {
        if (!dump_) return;
        nlohmann::ordered_json seen = state_.json(drawn);
        seen["loading"] = loader_.is_loading();
        seen["progress"] = loader_.is_loading() ? json_of(loader_.progress()) : nullptr;
        seen["busy"] = is_busy;
        seen["files"] = files_.count();
        seen["relinked"] = relinked_;
        seen["drawn"]["size"] = {drawn.settings.width, drawn.settings.height};
        seen["drawn"]["samples"] = drawn.settings.samples;
        seen["drawn"]["whole"] = !is_reduced(drawn.settings);
        seen["reduced"] = reduced_;
        seen["costs"] = json_of(prices_.state());
        seen["command_line"] = command_line();
        seen["compare"] = comparison_.json();
        seen["accuracy"] = accuracy_.json(state_.options());
        seen["drawn"]["beside"] = drawn.beside;
        seen["drawn"]["difference"] = drawn.is_difference;
        seen["saved"] = json_of(captured_->state());
        seen["saved_files"] = saving_.json();
        seen["layout"] = {{"scale", interface_.scale().layout},
                          {"panels", panel_names()},
                          {"open", layout_.open_panels},
                          {"note", remembered_.note()}};
        seen["typing"] = UserInterface::is_typing();
        const std::optional<glm::ivec2> pointer = UserInterface::pointer();
        seen["pointer"] = pointer ? nlohmann::ordered_json{pointer->x, pointer->y} : nullptr;
        seen["help"] = interface_.is_help_open();
        seen["places"] = places_json();
        const std::string text = seen.dump(2) + "\n";
        if (text == dumped_) return;
        dumped_ = text;
        replace_file(*dump_, std::as_bytes(std::span(text)));
    }

    RememberedLayout remembered_;
    WindowLayout layout_;
    WindowSystem system_;
    DrawThread drawer_;
    Loader loader_;
    HealthSearch health_;
    FollowedFiles files_;
    UserInterface interface_;
    ViewerState state_;
    Comparison comparison_;
    SceneAccuracy accuracy_;
    Saving saving_;
    ViewOptions reading_;                   ///< What was last begun to be read.
    std::optional<glm::ivec2> asked_view_;  ///< Until the first frame shows how large it is.
    std::optional<float> ui_scale_;         ///< By option, until another one is chosen.
    std::optional<std::filesystem::path> dump_;
    std::string dumped_;
    CaptureSettings capture_settings_;
    std::shared_ptr<CaptureProgress> captured_ = std::make_shared<CaptureProgress>();
    EffectPrices prices_;
    ShaderPanel shaders_;
    std::optional<DrawWish> wished_;
    Resolution resolution_;
    FrameSettings asked_;            ///< Of the last wish, whole or not.
    std::uint64_t reduced_ = 0;      ///< Wishes that were not.
    std::uint64_t relinked_ = 0;     ///< How often shaders have changed.
    bool is_resting_later_ = false;  ///< The whole picture is still to come.
    int settling_ = frames_to_settle;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

ExitCode run_window(const ViewOptions& options) {
    WindowLoop(options).run();
    return ExitCode::done;
}

}  // namespace relief::tools
