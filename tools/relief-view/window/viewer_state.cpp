// SPDX-License-Identifier: Apache-2.0
#include "window/viewer_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "debug_options.h"
#include "scene_options.h"
#include "window/draw_thread.h"
#include "window/material_panel.h"
#include "window/orbit_camera.h"

namespace relief::tools {

SceneTree tree_of(const SceneGraph& graph) {
    SceneTree tree;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
        const std::string& name = graph.nodes[i].name;
        tree.nodes.emplace_back().name = name.empty() ? fmt::format("node {}", i) : name;
    }
    const auto node_of = [&](std::optional<std::size_t> node) -> TreeNode& {
        return node ? tree.nodes.at(*node) : tree.world;
    };
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        node_of(graph.nodes[i].parent).children.push_back(i);
    // The list may be shorter than the objects. The others belong to the world.
    const auto holder = [&](const std::vector<Carried>& carried, std::size_t i) -> TreeNode& {
        return node_of(i < carried.size() ? carried[i].node : std::nullopt);
    };
    for (std::size_t i = 0; i < graph.scene.instances.size(); ++i)
        holder(graph.instances, i).instances.push_back(i);
    const auto hang = [&](const std::vector<Carried>& carried, std::size_t count,
                          const char* kind) {
        for (std::size_t i = 0; i < count; ++i)
            holder(carried, i).carried.push_back(fmt::format("{} light {}", kind, i + 1));
    };
    const Scene& scene = graph.scene;
    hang(graph.directional_lights, scene.directional_lights.size(), "directional");
    hang(graph.point_lights, scene.point_lights.size(), "point");
    hang(graph.spot_lights, scene.spot_lights.size(), "spot");
    if (scene.camera) node_of(graph.camera.node).carried.emplace_back("camera");
    return tree;
}

std::vector<std::size_t> instances_below(const SceneTree& tree, const TreeNode& node) {
    std::vector<std::size_t> all = node.instances;
    std::vector<std::size_t> open = node.children;
    while (!open.empty()) {
        const TreeNode& next = tree.nodes[open.back()];
        open.pop_back();
        all.insert(all.end(), next.instances.begin(), next.instances.end());
        open.insert(open.end(), next.children.begin(), next.children.end());
    }
    return all;
}

namespace {

constexpr float quarter = 0.5F * std::numbers::pi_v<float>;
constexpr float key_turn = quarter / 18.0F;  // 5 degrees.
constexpr float turntable_speed = 0.5F;      // Radians per second.
constexpr float fov_step = 1.1F;

float changed_fov(float fov, float factor) {
    return std::clamp(fov * factor, glm::radians(2.0F), glm::radians(150.0F));
}

}  // namespace

ViewerState::ViewerState(ViewOptions options)
    : options_(std::move(options)), effects_(options_.effects.requests) {}

void ViewerState::take(Loaded loaded) {
    error_ = loaded.error;
    if (!loaded.composed) return;
    const bool is_new = loaded.options.model != shown_model_;
    const DebugChoices debug = options_.debug;  // The window's debug settings stay.
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
    rebased_ = scene_ ? rebase_edits(*read_, *scene_, *scene) : RebasedEdits{};
    notes_.insert(notes_.end(), rebased_.lost.begin(), rebased_.lost.end());
    if (is_new || hidden_.size() != scene->instances.size())
        hidden_.assign(scene->instances.size(), false);
    replace(std::move(scene));
    light_rows_.update(*scene_);
    read_ = std::move(read);
    edit_error_.clear();
    ++scenes_;
    sphere_ = bounding_sphere(world_bounds(*scene_));
    mark_health();
    if (!is_new) return;
    const std::optional<CameraOption>& view = options_.camera;
    camera_ = view && view->place ? orbit_of(*view, *view->place, camera.vertical_fov)
                                  : orbit_of(camera, sphere_);
}

/// Replaces the scene, and updates the scene without hidden instances.
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

std::vector<LightRow> ViewerState::light_rows() const {
    return scene_ ? light_rows_.rows(*scene_) : std::vector<LightRow>();
}

void ViewerState::set_light_rows(std::vector<LightRow> rows) {
    edit([&](Scene& scene) { light_rows_.set(scene, std::move(rows)); });
}

void ViewerState::orbit_lights(const glm::vec2& pixels) {
    if (!scene_ || view_.y == 0) return;
    const float unit = 2.0F * quarter / static_cast<float>(view_.y);
    const glm::vec3 right(std::cos(camera_.azimuth), 0.0F, -std::sin(camera_.azimuth));
    glm::mat4 rotation = glm::rotate(glm::mat4(1.0F), unit * pixels.y, right);
    rotation = glm::rotate(rotation, unit * pixels.x, {0.0F, 1.0F, 0.0F});
    edit([&](Scene& scene) {
        std::vector<AnyLight> lights = lights_of(scene);
        for (AnyLight& light : lights)
            tools::turn(light, glm::mat3(rotation), sphere_.center);
        tools::set_lights(scene, lights);
    });
}

void ViewerState::aim(const glm::vec2& pointer) {
    if (!scene_) return;
    const Ray ray = ray_through(camera_of(camera_, sphere_), pointer);
    if (const std::optional<glm::vec3> point = surface_hit(*shown_, ray)) aim_at(camera_, *point);
}

void ViewerState::apply_view_text(const std::string& text) {
    error_.clear();
    try {
        const ViewText view = parse_view_text(text);
        const float fov = view.vertical_fov.value_or(camera_.vertical_fov);
        // Without a target, only the direction changes.
        const CameraPlace place =
            view.camera.place.value_or(CameraPlace{camera_.target, camera_.distance});
        camera_ = orbit_of(view.camera, place, fov);
    } catch (const UsageError& error) {
        error_ = error.what();
    }
}

void ViewerState::set_effects(EffectRequest effects) {
    effects_ = std::move(effects);
    ++revision_;
}

void ViewerState::mark_health() {
    markers_ = {};
    has_health_request_ = scene_ != nullptr;
}

std::optional<HealthRequest> ViewerState::take_health_request() {
    if (!std::exchange(has_health_request_, false)) return std::nullopt;
    return HealthRequest{scene_, options_.debug.health_markers};
}

void ViewerState::take(HealthResult found) {
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
    if (action == Action::picture_view) choices = {};
    if (action == Action::wireframe) choices.wireframe = !choices.wireframe;
    if (action == Action::vertex_frames) choices.vertex_frames = !choices.vertex_frames;
    if (action == Action::health_markers) {
        const bool were_on = choices.health_markers.has_value();
        choices.health_markers.reset();
        if (!were_on) choices.health_markers = HealthChoice::problem;
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
            return fit(camera_, sphere_, aspect);
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
        case Action::narrow_fov:
            camera_.vertical_fov = changed_fov(camera_.vertical_fov, 1.0F / fov_step);
            return;
        case Action::widen_fov:
            camera_.vertical_fov = changed_fov(camera_.vertical_fov, fov_step);
            return;
        case Action::turntable:
            is_turning_ = !is_turning_;
            return;
        case Action::zoom_in:
            return zoom_by(camera_, 1.0F, glm::vec2(0.0F), sphere_);
        case Action::zoom_out:
            return zoom_by(camera_, -1.0F, glm::vec2(0.0F), sphere_);
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
        case Action::picture_view:
        case Action::wireframe:
        case Action::vertex_frames:
        case Action::health_markers:
            return act_on_debug(action);
        default:
            return;  // The window handles the other actions.
    }
}

void ViewerState::set_view(const glm::ivec2& pixels) {
    view_ = pixels;
}

bool ViewerState::advance(double seconds) {
    if (light_rows_.is_moving())
        edit([&](Scene& scene) { light_rows_.advance(scene, seconds, sphere_.center); });
    if (!is_turning_) return light_rows_.is_moving();
    camera_.azimuth = std::remainder(
        camera_.azimuth - turntable_speed * static_cast<float>(seconds), 4.0F * quarter);
    return true;
}

std::optional<DrawRequest> ViewerState::request() const {
    if (!scene_ || view_.x <= 0 || view_.y <= 0) return std::nullopt;
    DrawRequest request;
    request.scene = shown_;
    request.revision = revision_;
    request.effects = effects_;
    request.settings.width = view_.x;
    request.settings.height = view_.y;
    request.settings.samples = options_.samples;
    request.settings.view = options_.debug.view;
    request.settings.overlays = overlays_of(options_.debug, markers_);
    request.camera = camera_of(camera_, sphere_);
    return request;
}

std::string ViewerState::command_line() const {
    return fmt::format("--camera {} --fov {} --size {}x{}", to_text(camera_),
                       degrees_text(camera_.vertical_fov), view_.x, view_.y) +
           command_line_of(options_.debug);
}

nlohmann::ordered_json ViewerState::json(const RenderedPicture& drawn) const {
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
                                    {"edits", {{"kept", rebased_.kept}, {"lost", rebased_.lost}}},
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
    for (const LightRow& row : light_rows()) {
        state["lights"].push_back(
            {{"kind", name_of(kind_of(row.light))}, {"speed", glm::degrees(row.speed)}});
    }
    if (drawn.plan) state["effects"] = effects_in(*drawn.plan);
    return state;
}

}  // namespace relief::tools
