// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/viewer_state_test.cpp.
#include "window/viewer_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "debug_options.h"
#include "environment_options.h"
#include "window/draw_thread.h"
#include "window/material_models.h"
#include "window/pasted_view.h"
#include "window/picking.h"

namespace relief::tools {
namespace {

constexpr float quarter = 0.5F * std::numbers::pi_v<float>;
constexpr float key_turn = quarter / 18.0F;  // 5 degrees.
constexpr float turntable_speed = 0.5F;      // Radians a second.
constexpr float fov_step = 1.1F;

float changed_fov(float fov, float factor) {
    return std::clamp(fov * factor, glm::radians(2.0F), glm::radians(150.0F));
}

}  // namespace

ViewerState::ViewerState(ViewOptions options)
    : options_(std::move(options)), effects_(options_.effects.wishes) {}

void ViewerState::take(Loaded loaded) {
    error_ = loaded.error;
    if (!loaded.composed) return;
    const bool is_new = loaded.options.model != shown_model_;
    const DebugChoices debug = options_.debug;  // Stays as it is now.
    options_ = std::move(loaded.options);
    options_.debug = debug;
    shown_model_ = options_.model;
    notes_ = std::move(loaded.composed->notes);
    findings_ = std::move(loaded.findings);
    const Camera camera = loaded.composed->camera;
    tree_ = tree_of(loaded.composed->graph);
    auto scene = std::make_shared<Scene>(std::move(loaded.composed->scene()));
    if (has_named_default_) relief::name_default_material(*scene);
    auto read = std::make_shared<const Scene>(*scene);
    kept_ = scene_ ? keep_edits(*read_, *scene_, *scene) : KeptEdits{};
    notes_.insert(notes_.end(), kept_.lost.begin(), kept_.lost.end());
    if (is_new || hidden_.size() != scene->instances.size())
        hidden_.assign(scene->instances.size(), false);
    replace(std::move(scene));
    lamps_.meet(*scene_);
    read_ = std::move(read);
    edit_error_.clear();
    ++scenes_;
    ball_ = ball_around(world_bounds(*scene_));
    mark_health();
    if (!is_new) return;
    const std::optional<CameraOption>& view = options_.camera;
    camera_ = view && view->place ? orbit_of(*view, *view->place, camera.vertical_fov)
                                  : orbit_of(camera, ball_);
}

/// Another scene, or the same one edited.
void ViewerState::replace(std::shared_ptr<const Scene> scene) {
    scene_ = std::move(scene);
    shown_ = scene_;
    if (std::find(hidden_.begin(), hidden_.end(), true) != hidden_.end()) {
        auto shown = std::make_shared<Scene>(*scene_);
        shown->instances.clear();
        for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
            if (is_shown(i)) shown->instances.push_back(scene_->instances[i]);
        }
        shown_ = std::move(shown);
    }
    ++revision_;
}

void ViewerState::show(const std::vector<std::size_t>& instances, bool are_shown) {
    for (const std::size_t instance : instances)
        hidden_[instance] = !are_shown;
    replace(scene_);
}

void ViewerState::name_default_material() {
    if (!scene_) return;
    has_named_default_ = true;
    auto read = std::make_shared<Scene>(*read_);
    relief::name_default_material(*read);
    read_ = std::move(read);
    edit(relief::name_default_material);
}

void ViewerState::set_environment(const std::filesystem::path& file) {
    ViewOptions options;
    options.environment = {file};
    try_edit([&](Scene& scene) {
        Environment environment = environment_of(options);
        environment.lights = std::any_of(
            scene.materials.begin(), scene.materials.end(), [](const Material& material) {
                return model_of(material) == MaterialModel::metallic_roughness;
            });
        if (scene.environment) {
            environment.intensity = scene.environment->intensity;
            environment.skybox = scene.environment->skybox;
            environment.lights = scene.environment->lights;
        }
        scene.environment = std::move(environment);
        options_.environment = options.environment;
        options_.environment_layout.reset();
        options_.left_handed_environment = false;
    });
}

std::vector<LampRow> ViewerState::lamps() const {
    return scene_ ? lamps_.rows(*scene_) : std::vector<LampRow>();
}

void ViewerState::set_lamps(std::vector<LampRow> rows) {
    edit([&](Scene& scene) { lamps_.set(scene, std::move(rows)); });
}

void ViewerState::orbit_lights(const glm::vec2& pixels) {
    if (!scene_ || view_.y == 0) return;
    const float unit = 2.0F * quarter / static_cast<float>(view_.y);
    const glm::vec3 right(std::cos(camera_.azimuth), 0.0F, -std::sin(camera_.azimuth));
    glm::mat4 rotation = glm::rotate(glm::mat4(1.0F), unit * pixels.y, right);
    rotation = glm::rotate(rotation, unit * pixels.x, {0.0F, 1.0F, 0.0F});
    edit([&](Scene& scene) {
        std::vector<Lamp> lamps = lamps_of(scene);
        for (Lamp& lamp : lamps)
            tools::turn(lamp, glm::mat3(rotation), ball_.center);
        tools::set_lamps(scene, lamps);
    });
}

void ViewerState::aim(const glm::vec2& pointer) {
    if (!scene_) return;
    const Ray ray = ray_through(camera_of(camera_, ball_), pointer);
    if (const std::optional<glm::vec3> point = surface_on(*shown_, ray)) aim_at(camera_, *point);
}

void ViewerState::look_as(const std::string& text) {
    error_.clear();
    try {
        const PastedView view = pasted_view(text);
        const float fov = view.vertical_fov.value_or(camera_.vertical_fov);
        // Without a place, it is the same one from another side.
        const CameraPlace place =
            view.camera.place.value_or(CameraPlace{camera_.target, camera_.distance});
        camera_ = orbit_of(view.camera, place, fov);
    } catch (const UsageError& error) {
        error_ = error.what();
    }
}

void ViewerState::set_effects(EffectWishes effects) {
    effects_ = std::move(effects);
    ++revision_;
}

void ViewerState::mark_health() {
    markers_ = {};
    wishes_health_ = scene_ != nullptr;
}

std::optional<HealthWish> ViewerState::take_health_wish() {
    if (!std::exchange(wishes_health_, false)) return std::nullopt;
    return HealthWish{scene_, options_.debug.health_markers};
}

void ViewerState::take(FoundHealth found) {
    if (!found.error.empty()) error_ = found.error;
    markers_ = std::move(found.markers);
    ++revision_;
}

void ViewerState::set_debug(const DebugChoices& choices) {
    const bool marks_change = choices.health_markers != options_.debug.health_markers;
    options_.debug = choices;
    if (marks_change) mark_health();
    ++revision_;
}

void ViewerState::act_on_debug(Action action) {
    DebugChoices choices = options_.debug;
    const std::size_t count = debug_views().size();
    const auto turn = [&](std::size_t by) {
        choices.view =
            static_cast<DebugView>((static_cast<std::size_t>(choices.view) + by) % count);
    };
    if (action == Action::next_view) turn(1);
    if (action == Action::previous_view) turn(count - 1);
    if (action == Action::plain_view) choices = {};
    if (action == Action::wireframe) choices.wireframe = !choices.wireframe;
    if (action == Action::vertex_frames) choices.vertex_frames = !choices.vertex_frames;
    if (action == Action::health_markers) {
        const bool were_on = choices.health_markers.has_value();
        choices.health_markers.reset();
        if (!were_on) choices.health_markers = HealthChoice::trouble;
    }
    set_debug(choices);
}

void ViewerState::look_from(float azimuth, float elevation) {
    camera_.azimuth = azimuth;
    camera_.elevation = elevation;
}

void ViewerState::act(Action action) {
    const float aspect =
        view_.y > 0 ? static_cast<float>(view_.x) / static_cast<float>(view_.y) : 1.0F;
    switch (action) {
        case Action::fit:
            return fit(camera_, ball_, aspect);
        case Action::front:
            return look_from(0.0F, 0.0F);
        case Action::back:
            return look_from(2.0F * quarter, 0.0F);
        case Action::right:
            return look_from(quarter, 0.0F);
        case Action::left:
            return look_from(-quarter, 0.0F);
        case Action::top:
            return look_from(0.0F, quarter);
        case Action::bottom:
            return look_from(0.0F, -quarter);
        case Action::narrower:
            camera_.vertical_fov = changed_fov(camera_.vertical_fov, 1.0F / fov_step);
            return;
        case Action::wider:
            camera_.vertical_fov = changed_fov(camera_.vertical_fov, fov_step);
            return;
        case Action::turntable:
            is_turning_ = !is_turning_;
            return;
        case Action::nearer:
            return zoom_by(camera_, 1.0F, glm::vec2(0.0F), ball_);
        case Action::farther:
            return zoom_by(camera_, -1.0F, glm::vec2(0.0F), ball_);
        case Action::orbit_left:
            return look_from(camera_.azimuth - key_turn, camera_.elevation);
        case Action::orbit_right:
            return look_from(camera_.azimuth + key_turn, camera_.elevation);
        case Action::orbit_up:
            return look_from(camera_.azimuth, std::min(camera_.elevation + key_turn, quarter));
        case Action::orbit_down:
            return look_from(camera_.azimuth, std::max(camera_.elevation - key_turn, -quarter));
        case Action::next_view:
        case Action::previous_view:
        case Action::plain_view:
        case Action::wireframe:
        case Action::vertex_frames:
        case Action::health_markers:
            return act_on_debug(action);
        default:
            return;  // The window's own.
    }
}

void ViewerState::set_view(const glm::ivec2& pixels) {
    view_ = pixels;
}

bool ViewerState::pass(double seconds) {
    if (lamps_.is_moving()) edit([&](Scene& scene) { lamps_.pass(scene, seconds, ball_.center); });
    if (!is_turning_) return lamps_.is_moving();
    camera_.azimuth = std::remainder(
        camera_.azimuth - turntable_speed * static_cast<float>(seconds), 4.0F * quarter);
    return true;
}

std::optional<DrawWish> ViewerState::wish() const {
    if (!scene_ || view_.x <= 0 || view_.y <= 0) return std::nullopt;
    DrawWish wish;
    wish.scene = shown_;
    wish.revision = revision_;
    wish.effects = effects_;
    wish.settings.width = view_.x;
    wish.settings.height = view_.y;
    wish.settings.samples = options_.samples;
    wish.settings.view = options_.debug.view;
    wish.settings.overlays = overlays_of(options_.debug, markers_);
    wish.camera = camera_of(camera_, ball_);
    return wish;
}

std::string ViewerState::command_line() const {
    return fmt::format("--camera {} --fov {} --size {}x{}", to_text(camera_),
                       degrees_text(camera_.vertical_fov), view_.x, view_.y) +
           command_line_of(options_.debug);
}

nlohmann::ordered_json ViewerState::json(const DrawnPicture& drawn) const {
    const auto numbers = [](const glm::vec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
    nlohmann::ordered_json state = {{"model", options_.model.string()},
                                    {"error", !error().empty() ? error() : drawn.error},
                                    {"view", {view_.x, view_.y}},
                                    {"camera",
                                     {{"azimuth", glm::degrees(camera_.azimuth)},
                                      {"elevation", glm::degrees(camera_.elevation)},
                                      {"distance", camera_.distance},
                                      {"target", numbers(camera_.target)},
                                      {"fov", glm::degrees(camera_.vertical_fov)}}},
                                    {"show", debug_view_info(options_.debug.view).name},
                                    {"overlays", overlays_json(options_.debug, markers_)},
                                    {"turntable", is_turning_},
                                    {"scenes", scenes_},
                                    {"edits", {{"kept", kept_.kept}, {"lost", kept_.lost}}},
                                    {"revision", revision_},
                                    {"drawn",
                                     {{"revision", drawn.revision},
                                      {"frames", drawn.frames},
                                      {"renderers", drawn.renderers},
                                      {"milliseconds", drawn.times.draw}}}};
    if (!scene_) return state;
    std::size_t triangles = 0;
    for (const Instance& instance : scene_->instances)
        triangles += scene_->meshes[instance.mesh]->triangles.size();
    state["triangles"] = triangles;
    state["shown"] = {shown_->instances.size(), scene_->instances.size()};
    state["materials"] = scene_->materials.size();
    nlohmann::json lights = nlohmann::json::array();
    for (const DirectionalLight& light : scene_->directional_lights)
        lights.push_back(numbers(light.direction_world));
    state["directional_lights"] = lights;
    state["lights"] = nlohmann::json::array();
    for (const LampRow& row : lamps()) {
        state["lights"].push_back(
            {{"kind", name_of(kind_of(row.lamp))}, {"speed", glm::degrees(row.speed)}});
    }
    if (drawn.plan) state["effects"] = effects_in(*drawn.plan);
    return state;
}

}  // namespace relief::tools
