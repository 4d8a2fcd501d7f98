// SPDX-License-Identifier: Apache-2.0
#include "window/capture.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <optional>

#include "picture_sequence.h"
#include "picture_sink.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/scene_file.h"
#include "saved_files.h"
#include "window/background_jobs.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// A renderer with the scene that it rotates.
class Capturing {
  public:
    explicit Capturing(CaptureRequest request) : request_(std::move(request)) {
        composed_.graph.scene = *request_.scene;
        Scene& scene = composed_.scene();
        if (request_.transparent) {
            scene.background = glm::vec4(0.0F);
            if (scene.environment) scene.environment->skybox = false;
        }
        composed_.middle = request_.middle;
        for (const Instance& instance : scene.instances)
            composed_.at_rest.push_back(instance.world_from_object);
        if (request_.turntable > 0) options_.turntable = request_.turntable;
    }

    [[nodiscard]] int count() const { return std::max(request_.turntable, 1); }

    /// Draws and writes picture `index`, starting with 0. \return its file
    std::filesystem::path save(int index, const Context& context, RenderCache& cache) {
        if (!renderer_) prepare(context, cache);
        if (index > 0) {
            pose_for(composed_, options_, index);
            renderer_->move(composed_.scene());
        }
        Image picture = renderer_->draw(request_.camera).image;
        if (composed_.scene().background.a == 1.0F) drop_alpha(picture);
        const std::filesystem::path file =
            request_.turntable > 0 ? numbered_file(request_.file, index + 1) : request_.file;
        write_image(file, picture);
        return file;
    }

  private:
    void prepare(const Context& context, RenderCache& cache) {
        Report unused;  // The window has already shown these findings.
        const Scene& scene = composed_.scene();
        renderer_.emplace(cache, context, scene,
                          forced_plan(scene, request_.settings, request_.effects),
                          request_.settings, unused);
    }

    CaptureRequest request_;
    ComposedScene composed_;
    ViewOptions options_;
    std::optional<Renderer> renderer_;
};

}  // namespace

CaptureProgress::State CaptureProgress::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

void CaptureProgress::set(const State& state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
}

nlohmann::ordered_json json_of(const CaptureProgress::State& state) {
    return {
        {"done", state.done}, {"count", state.count}, {"file", state.file}, {"error", state.error}};
}

std::string text_of(const CaptureProgress::State& state) {
    if (!state.error.empty()) return "Not saved: " + state.error;
    if (state.done < state.count)
        return fmt::format("Saving picture {} of {}", state.done + 1, state.count);
    if (state.count > 1) return fmt::format("Saved {} pictures, to {}", state.count, state.file);
    return state.file.empty() ? "" : "Saved " + state.file;
}

DrawTask capture_task(CaptureRequest request, std::shared_ptr<CaptureProgress> progress) {
    const auto capturing = std::make_shared<Capturing>(std::move(request));
    CaptureProgress::State initial;
    initial.count = capturing->count();
    progress->set(initial);
    return [capturing, progress](const Context& context, RenderCache& cache) {
        CaptureProgress::State state = progress->state();
        try {
            state.file = capturing->save(state.done, context, cache).string();
            ++state.done;
        } catch (const std::exception& error) {
            state.error = error.what();
        }
        progress->set(state);
        return state.is_running();
    };
}

namespace {

/// Returns whether a file exists. A broken symbolic link counts as existing.
bool is_taken(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::symlink_status(file, error).type() !=
           std::filesystem::file_type::not_found;
}

bool is_free(const std::filesystem::path& file, int turntable) {
    if (turntable == 0) return !is_taken(file);
    for (int i = 1; i <= turntable; ++i) {
        if (is_taken(numbered_file(file, i))) return false;
    }
    return true;
}

}  // namespace

std::filesystem::path free_file(const std::filesystem::path& model, int turntable) {
    for (int number = 1;; ++number) {
        const std::filesystem::path file =
            model.parent_path() /
            fmt::format("{}-{}{}.png", model.stem().string(), turntable > 0 ? "turn-" : "", number);
        if (is_free(file, turntable)) return file;
    }
}

std::filesystem::path free_beside(const std::filesystem::path& model, const std::string& middle,
                                  const std::string& extension) {
    for (int number = 1;; ++number) {
        const std::filesystem::path file =
            model.parent_path() /
            fmt::format("{}{}{}{}", model.stem().string(), middle, number, extension);
        if (!is_taken(file)) return file;
    }
}

void Saving::begin(const std::filesystem::path& file, std::function<void()> save) {
    text_ = "Saving " + file.string();
    job_.start([file, work = std::move(save)](const Progress&) {
        Saved saved{file, ""};
        try {
            work();
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception& error) {
            saved.error = error.what();
        }
        return saved;
    });
}

void Saving::save_scene(ViewerState& state) {
    const std::optional<DrawRequest> request = state.request();
    if (!request || is_running()) return;
    const std::filesystem::path model = state.options().model;
    const std::filesystem::path file = free_beside(model, "-scene-", ".json");
    // Hidden instances are saved too, because hiding affects only the picture.
    const std::shared_ptr<const Scene> scene = state.scene_at_rest();
    begin(file, [model, file, scene, camera = request->camera, size = state.view(),
                 options = scene_options(state.options())] {
        shade::save_scene(file, {model, *scene, camera, size, options});
    });
}

void Saving::save_model(const ViewerState& state) {
    if (!state.has_scene() || is_running()) return;
    const std::filesystem::path model = state.options().model;
    const std::filesystem::path file = free_beside(model, "-model-", ".glb");
    begin(file, [model, file, options = scene_options(state.options())] {
        tools::save_model(file, model, options);
    });
}

void Saving::follow() {
    if (std::optional<Saved> saved = job_.take()) {
        saved_ = std::move(*saved);
        text_ =
            saved_.error.empty() ? "Saved " + saved_.file.string() : "Not saved: " + saved_.error;
    }
}

nlohmann::ordered_json Saving::json() const {
    return {{"going_on", is_running()}, {"file", saved_.file.string()}, {"error", saved_.error}};
}

namespace {

constexpr int largest_picture_side = 16384;

bool button(const char* label) {
    const bool is_pressed = ImGui::Button(label);
    probe_item(label);
    return is_pressed;
}

}  // namespace

void draw_capture_panel(const PanelInput& input, PanelRequests& requests) {
    if (!input.state.has_scene() || input.capture == nullptr) return;
    CaptureSettings& settings = *input.capture;
    check("Custom size", settings.custom_size);
    if (settings.custom_size) {
        ImGui::InputInt(begin_row("Width, pixels").c_str(), &settings.width, 0);
        ImGui::InputInt(begin_row("Height, pixels").c_str(), &settings.height, 0);
        settings.width = std::clamp(settings.width, 1, largest_picture_side);
        settings.height = std::clamp(settings.height, 1, largest_picture_side);
    }
    check("Transparent background", settings.transparent);
    if (button("Save picture")) requests.save_picture = true;
    ImGui::InputInt(begin_row("Pictures per turn").c_str(), &settings.pictures, 1, 12);
    settings.pictures = std::clamp(settings.pictures, 2, 9999);
    if (button("Save turntable")) requests.save_turn = true;
    if (button("Save scene (JSON)")) requests.save_scene = true;
    if (button("Save model (GLB)")) requests.save_model = true;
    if (!input.captured.empty()) ImGui::TextWrapped("%s", input.captured.c_str());
}

}  // namespace relief::tools
