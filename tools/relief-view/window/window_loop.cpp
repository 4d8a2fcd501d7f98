// SPDX-License-Identifier: Apache-2.0
// The main loop of the window, which draws when something has changed and sleeps otherwise.
// Tests: tests/tools/window/window_test.cpp.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command_line.h"
#include "common/command.h"
#include "common/text.h"
#include "file_replacement.h"
#include "files.h"
#include "light_options.h"
#include "view_command.h"
#include "window/background_jobs.h"
#include "window/capture.h"
#include "window/comparison.h"
#include "window/controls.h"
#include "window/input_files.h"
#include "window/panels.h"
#include "window/probe_panel.h"
#include "window/scene_accuracy.h"
#include "window/shader_panel.h"
#include "window/user_interface.h"
#include "window/window_system.h"

namespace relief::tools {
using namespace relief::detail;

namespace {

constexpr int frames_to_settle = 3;  // Dear ImGui reacts to the previous frame.
constexpr double turning_step = 1.0 / 60.0;
constexpr double loading_step = 0.1;  // Seconds between progress updates.

/// {"stage", "part": 0 to 1, or null if it is unknown}
nlohmann::ordered_json json_of(const Progress::State& progress) {
    return {{"stage", progress.stage},
            {"part", progress.part ? nlohmann::ordered_json(*progress.part) : nullptr}};
}

SavedLayout saved_layout(const ViewOptions& options) {
    const std::optional<std::filesystem::path> file = default_layout_file();
    return options.no_state || !file ? SavedLayout() : SavedLayout(*file);
}

class WindowLoop {
  public:
    explicit WindowLoop(const ViewOptions& options)
        : saved_layout_(saved_layout(options)),
          layout_(saved_layout_.layout()),
          system_("relief-view", layout_),
          drawer_({[this] { system_.use_worker_context(); },
                   [this] { system_.release_worker_context(); }, WindowSystem::loader(),
                   WindowSystem::wake}),
          loader_(WindowSystem::wake),
          health_(WindowSystem::wake),
          thumbnails_(WindowSystem::wake),
          previews_(WindowSystem::wake),
          files_(WindowSystem::wake),
          interface_(system_),
          state_(options),
          comparison_(options.compare, WindowSystem::wake),
          accuracy_(WindowSystem::wake),
          saving_(WindowSystem::wake),
          probe_(WindowSystem::wake),
          loading_options_(options),
          ui_scale_(options.ui_scale),
          state_file_(options.dump_state) {
        if (state_file_) enable_ui_probe();
        layout_.has_seen_hint |= !saved_layout_.has_file();
        if (options.size_given) requested_view_size_ = options.size;
        if (!options.model.empty()) loader_.start(loading_options_);
    }

    void run() {
        while (!system_.is_closing()) {
            const bool was_working = is_working();
            wait();
            take_results();
            state_.advance(seconds_since_last());
            accuracy_.follow(state_);
            comparison_.follow(state_);
            saving_.follow();
            follow_shaders();
            // Tables find their column widths after the first frame with the results.
            if (was_working && !is_working()) pending_frames_ = frames_to_settle;
            if (system_.is_visible()) draw();
        }
        system_.hide();  // Threads may need a moment to end.
        // A size from the command line is not stored.
        if (!state_.options().size_given) system_.store_geometry(layout_);
        if (const std::string problem = saved_layout_.save(layout_); !problem.empty())
            fmt::print(err(), "relief-view: warning: {}\n", printable(problem));
    }

  private:
    /// Collects the results of other threads.
    void take_results() {
        if (std::optional<Loaded> loaded = loader_.take()) {
            files_.follow(*loaded);
            if (loaded->error.empty() && !loaded->options.model.empty())
                remember_file(layout_, loaded->options.model);
            state_.take(std::move(*loaded));
            pending_frames_ = frames_to_settle;
        }
        if (std::optional<HealthRequest> request = state_.take_health_request())
            health_.start(std::move(*request));
        if (std::optional<HealthResult> found = health_.take()) state_.take(std::move(*found));
        if (std::optional<Image> picture = thumbnails_.take())
            drawer_.put_thumbnails(std::move(*picture));
        if (std::optional<Image> picture = previews_.take()) {
            drawer_.put_previews(std::move(*picture));
            pending_frames_ = frames_to_settle;
        }
        take_changes(files_.take());
    }

    /// Reloads changed files. The camera and the edits stay.
    void take_changes(const WatchedFiles::Changed& changed) {
        if (changed.scene || changed.attempt) {
            // A model that is still being read is read again.
            if (!loader_.is_loading() && !changed.attempt) loading_options_ = state_.options();
            loader_.start(loading_options_);
        }
        if (changed.picture) state_.refresh();
        if (changed.shaders) {
            drawer_.relink();
            requested_.reset();
            ++relinked_;
        }
    }

    /// Sleeps until there is work.
    void wait() {
        if (pending_frames_ > 0) {
            --pending_frames_;
            glfwPollEvents();
            return;
        }
        if (state_.is_turning()) {
            WindowSystem::wait(turning_step);
        } else if (is_full_resolution_pending_ && system_.is_visible()) {
            constexpr double drawing_step = 0.02;
            WindowSystem::wait(
                std::max(resolution_.seconds_until_rest(glfwGetTime()), drawing_step));
        } else {
            WindowSystem::wait(is_working() ? loading_step : 0.0);
            if (!is_working()) pending_frames_ = frames_to_settle - 1;
        }
    }

    /// Applies edits of shaders, the chosen step and mistake, and compares an exercise with its
    /// solution.
    void follow_shaders() {
        shaders_.follow(state_.options().exercise, glfwGetTime());
        MistakeChoice& mistakes = shaders_.mistakes();
        state_.set_shaders(mistakes.texts(shaders_.edits().texts()), shaders_.steps().chosen());
        std::optional<DrawRequest> request = state_.request();
        if (!request) return;
        request->settings.shaders = shaders_.edits().texts();
        if (std::optional<DrawTask> task = mistakes.begin(*request, glfwGetTime()))
            drawer_.add(std::move(*task));
        request->scene = state_.shared_scene();
        if (std::optional<DrawTask> task = shaders_.exercise_check().begin(
                state_.options().exercise, *request, state_.options().size))
            drawer_.add(std::move(*task));
    }

    /// While work is in progress, the window draws frames to show it.
    bool is_working() {
        return loader_.is_loading() || drawer_.is_busy() || accuracy_.is_measuring() ||
               effect_times_.state().is_running || captured_->state().is_running() ||
               saving_.is_running() || probe_.is_working() || shaders_.edits().is_pending() ||
               shaders_.exercise_check().is_working() || shaders_.mistakes().is_pending();
    }

    double seconds_since_last() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return std::min(seconds, 0.1);  // Limits the motion after a pause.
    }

    void draw() {
        // This must come first: if the thread is idle now, drawn() is the newest picture.
        const bool was_busy = drawer_.is_busy();
        const RenderedPicture drawn = drawer_.drawn();
        files_.follow(drawn);
        note_picture(drawn);
        if (!was_busy) note_rest(drawn);
        interface_.set_scale(scale());
        interface_.set_theme(layout_.has_light_theme);
        const PanelInput input{state_,
                               layout_,
                               drawn,
                               drawer_.renderer_name(),
                               loader_.seconds_so_far(),
                               loader_.is_loading() ? &loading_options_ : nullptr,
                               loader_.is_loading() ? loader_.progress() : drawer_.progress(),
                               was_busy || is_full_resolution_pending_,
                               &capture_settings_,
                               notice_.empty() ? saved_text() : notice_,
                               saved_layout_.note(),
                               effect_times_,
                               shaders_,
                               &comparison_,
                               &accuracy_,
                               &thumbnails_,
                               drawer_.thumbnails(),
                               &probe_,
                               &previews_,
                               drawer_.previews()};
        const UserInterface::Events events = interface_.draw(input, drawer_.shown());
        if (state_.has_scene()) thumbnails_.update(state_.scene());
        previews_.update();
        // Input may arrive while the panels settle after earlier input.
        if (events.has_input) pending_frames_ = frames_to_settle;
        if (events.panels.cancel_loading) cancel();
        if (events.panels.redraw) state_.refresh();
        if (events.has_released && !state_.is_turning()) resolution_.end_motion();
        if (events.clicked) probe_.click(*events.clicked);
        if (std::optional<DrawTask> task = probe_.follow(state_.request(), events.pixel))
            drawer_.add(std::move(*task));
        for (const Action action : events.actions)
            act(action);
        if (const auto view = std::exchange(requested_view_size_, std::nullopt))
            system_.grow(*view - state_.view());
        measure(drawn, events.panels);
        use_variant(events.panels.material_variant);
        use_occlusion(events.panels.ambient_occlusion);
        assume(events.panels.assume);
        handle_accuracy_requests(events.panels);
        if (events.panels.save_picture) save(0);
        if (events.panels.save_scene) saving_.save_scene(state_);
        if (events.panels.save_model) saving_.save_model(state_);
        if (events.panels.save_turn) save(capture_settings_.pictures);
        if (!events.dropped.empty()) drop(events.dropped);
        const bool is_busy = request_picture() || was_busy || is_full_resolution_pending_ ||
                             health_.is_running() || thumbnails_.is_running() ||
                             previews_.is_running();
        write_state(drawn, is_busy || accuracy_.is_working() || comparison_.is_working() ||
                               saving_.is_running() || probe_.is_working() ||
                               shaders_.edits().is_pending() ||
                               shaders_.exercise_check().is_working());
    }

    void act(Action action) {
        notice_.clear();
        state_.act(action);
        if (action == Action::help) interface_.show_help();
        if (action == Action::open) open();
        if (action == Action::cancel) cancel();
        if (action == Action::axis_gizmo) layout_.has_axes = !layout_.has_axes;
        if (action == Action::next_file) open_neighbor(true);
        if (action == Action::previous_file) open_neighbor(false);
        if (action == Action::theme) layout_.has_light_theme = !layout_.has_light_theme;
        if (action == Action::panels) interface_.toggle_panels(layout_);
        if (action == Action::larger_ui) rescale(next_ui_scale(interface_.scale().glyphs, true));
        if (action == Action::smaller_ui) rescale(next_ui_scale(interface_.scale().glyphs, false));
        if (action == Action::reset_ui_scale) rescale(std::nullopt);
        if (action == Action::quit) system_.close();
        if (action == Action::save_picture) save(0);
        if (action == Action::save_scene) saving_.save_scene(state_);
        if (action == Action::save_model) saving_.save_model(state_);
        if (action == Action::copy_camera)
            glfwSetClipboardString(system_.window(), command_line().c_str());
        if (action == Action::compare) comparison_.toggle();
        if (action == Action::pixel_probe) probe_.toggle();
        if (action == Action::swap_sides) comparison_.swap();
        if (action == Action::show_difference) comparison_.toggle_difference();
        if (action == Action::paste_camera) paste();
    }

    /// Cancels reading, or else the preparation of a picture.
    void cancel() {
        if (loader_.is_loading()) {
            loader_.cancel();
            notice_ =
                fmt::format("Reading {} was cancelled", loading_options_.model.filename().string());
            pending_frames_ = frames_to_settle;
        } else if (!drawer_.progress().stage.empty()) {
            drawer_.cancel();
        }
    }

    /// Learns how long pictures take.
    void note_picture(const RenderedPicture& drawn) {
        if (drawn.frames == noted_frames_) return;
        noted_frames_ = drawn.frames;
        const bool is_first = std::exchange(noted_revision_, drawn.revision) != drawn.revision;
        shade::FrameSettings full = drawn.settings;
        full.width = state_.view().x;
        full.height = state_.view().y;
        full.samples = state_.options().samples;
        resolution_.note_picture(drawn.settings, full, drawn.times.draw, is_first);
    }

    /// Measures the time from the last motion until its picture at full resolution is shown.
    /// \param drawn  the picture of the last request
    void note_rest(const RenderedPicture& drawn) {
        if (!moved_at_ || is_reduced(drawn.settings)) return;
        seconds_to_full_ = glfwGetTime() - *moved_at_;
        moved_at_.reset();
    }

    /// Shows the file dialog with the folder of the model.
    void open() {
        interface_.open_dialog({.target = {},
                                .title = "Open a model, a scene or a map",
                                .folder = folder_to_browse({}, loading_options_.model)});
    }

    void open_neighbor(bool is_next) {
        const auto file = neighbor_of(loading_options_.model, is_next);
        if (file) return drop({*file});
        if (!loading_options_.model.empty()) notice_ = "There is no other model in the folder";
    }

    [[nodiscard]] std::string command_line() const {
        return state_.command_line() + comparison_.command_line();
    }

    void paste() {
        const char* text = glfwGetClipboardString(system_.window());
        state_.apply_view_text(text == nullptr ? "" : text);
    }

    /// A scale that is set in the window is saved. It replaces the option.
    void rescale(std::optional<float> scale) {
        ui_scale_.reset();
        layout_.ui_scale = scale;
    }
    [[nodiscard]] UiScale scale() const {
        return ui_scale_for(ui_scale_ ? ui_scale_ : layout_.ui_scale, system_.content_scale(),
                            system_.pixels_to_unit());
    }

    /// Returns whether two requests show the same picture, in any resolution.
    static bool is_same(const DrawRequest& a, const DrawRequest& b) {
        return a.revision == b.revision && a.pose == b.pose && a.camera == b.camera &&
               a.instead == b.instead && a.beside.has_value() == b.beside.has_value() &&
               (!a.beside || a.beside->revision == b.beside->revision) &&
               a.settings.width == b.settings.width && a.settings.height == b.settings.height;
    }

    [[nodiscard]] bool is_reduced(const shade::FrameSettings& settings) const {
        return settings.width < state_.view().x || settings.height < state_.view().y ||
               settings.samples < state_.options().samples;
    }

    void drop(const std::vector<std::filesystem::path>& files) {
        read_with([&](const ViewOptions& options) { return with_dropped(options, files); });
    }

    /// Reads the model with changed options. Invalid options are reported like read errors.
    template <typename Change>
    void read_with(const Change& change) {
        try {
            // Changes apply to the model that is being read, if there is one.
            ViewOptions options =
                change(loader_.is_loading() ? loading_options_ : state_.options());
            options.debug = {};  // The window has its own debug settings.
            settle(options);
            loading_options_ = options;
            loader_.start(options);
        } catch (const std::exception& error) {
            Loaded refused;
            refused.error = error.what();
            state_.take(std::move(refused));
        }
    }

    /// Reads the model that was refused because of the kind of a map, and assumes that kind.
    void assume(const std::optional<MapKind>& kind) {
        if (!kind) return;
        read_with([&](const ViewOptions&) {
            ViewOptions options = loading_options_;
            options.assumed.push_back(*kind);
            return options;
        });
    }

    /// Reads the model with the materials of a variant.
    void use_variant(const std::optional<std::string>& variant) {
        if (!variant) return;
        read_with([&](ViewOptions options) {
            options.material_variant = variant->empty() ? std::nullopt : variant;
            return options;
        });
    }

    /// Reads the model with another distance of ambient occlusion.
    void use_occlusion(const std::optional<float>& distance) {
        if (!distance) return;
        read_with([&](ViewOptions options) {
            set_occlusion(options, *distance);
            return options;
        });
    }

    /// Starts measurements, and applies the chosen method. A kernel is an option of the height map,
    /// so the model is read again.
    void handle_accuracy_requests(const PanelRequests& requests) {
        if (requests.measure_accuracy) accuracy_.measure(state_);
        if (requests.stop_accuracy) accuracy_.stop();
        if (!requests.use_method) return;
        if (const Kernel* kernel = std::get_if<Kernel>(&*requests.use_method)) {
            read_with([&](ViewOptions options) {
                options.kernel = *kernel;
                return options;
            });
        } else {
            accuracy_.use(*requests.use_method);
        }
    }

    /// Starts and stops the measurement of effect times, and discards outdated ones.
    void measure(const RenderedPicture& drawn, const PanelRequests& requests) {
        const std::optional<DrawRequest> request = shown_request();
        if (!request || requests.stop_measuring) return effect_times_.cancel();
        if (requests.measure_effects) drawer_.add(effect_times_.start(*request));
        if (drawn.plan && drawn.revision == request->revision)
            effect_times_.discard_unless_valid_for(*drawn.plan, *request);
    }

    /// Saves one picture or a turntable, unless pictures are being saved.
    void save(int turntable) {
        const std::optional<DrawRequest> request = shown_request();
        if (!request || captured_->state().is_running()) return;
        CaptureRequest capture{.scene = request->scene,
                               .effects = request->effects,
                               .settings = request->settings,
                               .camera = request->camera,
                               .transparent = capture_settings_.transparent,
                               .turntable = turntable,
                               .middle = state_.sphere().center,
                               .file = free_file(state_.options().model, turntable)};
        if (capture_settings_.custom_size) {
            capture.settings.width = capture_settings_.width;
            capture.settings.height = capture_settings_.height;
        }
        drawer_.add(capture_task(std::move(capture), captured_));
    }

    /// The message about the last saved files.
    [[nodiscard]] std::string saved_text() const {
        const std::string pictures = text_of(captured_->state());
        return pictures.empty() || saving_.text().empty() ? pictures + saving_.text()
                                                          : pictures + "   " + saving_.text();
    }

    /// The request of the picture, with the chosen mistake.
    std::optional<DrawRequest> shown_request() {
        std::optional<DrawRequest> request = state_.request();
        if (request) request->scene = shaders_.mistakes().scene(request->scene);
        return request;
    }

    /// Requests a picture if it differs from the last request. \return whether it does
    bool request_picture() {
        std::optional<DrawRequest> request = shown_request();
        if (!request) return false;
        if (std::optional<DrawTask> task = comparison_.add_to(*request))
            drawer_.add(std::move(*task));
        const bool is_moved = !requested_ || !is_same(*requested_, *request);
        const double now = glfwGetTime();
        if (is_moved && requested_ && !request->instead) {
            resolution_.note_motion(now);
            moved_at_ = now;
        }
        DrawRequest reduced = *request;
        reduced.settings = resolution_.next_settings(request->settings, requested_settings_,
                                                     !drawer_.is_busy(), now);
        is_full_resolution_pending_ = is_reduced(reduced.settings);
        const bool is_as_asked = requested_settings_.width == reduced.settings.width &&
                                 requested_settings_.height == reduced.settings.height &&
                                 requested_settings_.samples == reduced.settings.samples;
        if (!is_moved && is_as_asked) return false;
        if (is_full_resolution_pending_) ++reduced_;
        requested_ = request;
        requested_settings_ = reduced.settings;
        drawer_.request(std::move(reduced));
        return true;
    }

    /// Writes the state for tests and scripts (--dump-state).
    void write_state(const RenderedPicture& drawn, bool is_busy) {
        if (!state_file_) return;
        nlohmann::ordered_json state = state_.json(drawn);
        state["loading"] = loader_.is_loading();
        state["progress"] = loader_.is_loading() ? json_of(loader_.progress()) : nullptr;
        state["busy"] = is_busy;
        state["files"] = files_.count();
        state["relinked"] = relinked_;
        state["drawn"]["size"] = {drawn.settings.width, drawn.settings.height};
        state["drawn"]["samples"] = drawn.settings.samples;
        state["drawn"]["whole"] = !is_reduced(drawn.settings);
        state["drawn"]["seconds_to_full"] =
            seconds_to_full_ ? nlohmann::ordered_json(*seconds_to_full_) : nullptr;
        state["reduced"] = reduced_;
        state["costs"] = json_of(effect_times_.state());
        state["command_line"] = command_line();
        state["shaders"] = shaders_.json();
        state["compare"] = comparison_.json();
        state["accuracy"] = accuracy_.json(state_.options());
        state["drawn"]["beside"] = drawn.beside;
        state["drawn"]["difference"] = drawn.is_difference;
        state["probe"] = probe_.json();
        state["saved"] = json_of(captured_->state());
        state["notice"] = notice_;
        state["saved_files"] = saving_.json();
        state["layout"] = {{"scale", interface_.scale().layout},
                           {"panels", panel_names()},
                           {"open", layout_.open_panels},
                           {"note", saved_layout_.note()}};
        state["typing"] = UserInterface::is_typing();
        const std::optional<glm::ivec2> pointer = UserInterface::pointer();
        state["pointer"] = pointer ? nlohmann::ordered_json{pointer->x, pointer->y} : nullptr;
        state["help"] = interface_.is_help_open();
        state["places"] = ui_probe_json();
        const std::string text = dumped(state);
        if (text == written_state_) return;
        written_state_ = text;
        replace_file(*state_file_, std::as_bytes(std::span(text)));
    }

    SavedLayout saved_layout_;
    WindowLayout layout_;
    WindowSystem system_;
    DrawThread drawer_;
    Loader loader_;
    HealthSearch health_;
    Thumbnails thumbnails_;
    ImagePreviews previews_;
    WatchedFiles files_;
    UserInterface interface_;
    ViewerState state_;
    Comparison comparison_;
    SceneAccuracy accuracy_;
    Saving saving_;
    ProbePanel probe_;
    ViewOptions loading_options_;  ///< Options of the last read.
    /// The view size from the command line, until the first frame is drawn.
    std::optional<glm::ivec2> requested_view_size_;
    std::optional<float> ui_scale_;  ///< The scale from the command line, until another one is set.
    std::optional<std::filesystem::path> state_file_;
    std::string written_state_;
    CaptureSettings capture_settings_;
    std::shared_ptr<CaptureProgress> captured_ = std::make_shared<CaptureProgress>();
    EffectTimes effect_times_;
    ShaderPanel shaders_;
    std::optional<DrawRequest> requested_;
    AdaptiveResolution resolution_;
    shade::FrameSettings requested_settings_;  ///< Settings of the last request.
    std::uint64_t noted_frames_ = 0;           ///< Of the last picture whose time is known.
    std::uint64_t noted_revision_ = 0;
    std::optional<double> moved_at_;  ///< The last motion, until its full picture is shown.
    std::optional<double> seconds_to_full_;
    std::uint64_t reduced_ = 0;   ///< Number of requests with reduced resolution.
    std::uint64_t relinked_ = 0;  ///< How often the programs were linked again.
    bool is_full_resolution_pending_ =
        false;  ///< The picture at full resolution is still to be drawn.
    int pending_frames_ = frames_to_settle;
    std::string notice_;  ///< The status line shows it until the next action.
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

ExitCode run_window(const ViewOptions& options) {
    WindowLoop(options).run();
    return ExitCode::done;
}

}  // namespace relief::tools
