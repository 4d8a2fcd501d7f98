// SPDX-License-Identifier: Apache-2.0
// The state of the viewer, and the actions that change it.
// Tests: tests/tools/window/viewer_state_test.cpp, user_interface_test.cpp.
#include "window/viewer_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "effect_options.h"
#include "environment_options.h"
#include "light_options.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene_fields.h"
#include "scene_options.h"
#include "window/background_jobs.h"
#include "window/edit_panels.h"
#include "window/orbit_camera.h"

namespace relief::tools {
using namespace relief::shade;

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
constexpr double step_seconds = 1.0 / 25.0;  // Of the animation.
constexpr float marker_share = 0.03F;        // Of the radius of the scene.
constexpr float fov_step = 1.1F;
constexpr std::size_t max_undo = 200;

float changed_fov(float fov, float factor) {
    return std::clamp(fov * factor, glm::radians(min_fov_degrees), glm::radians(max_fov_degrees));
}

/// Returns the position and direction of a light; zero where it has none.
std::pair<glm::vec3, glm::vec3> place_of(const AnyLight& light) {
    if (const auto* directional = std::get_if<DirectionalLight>(&light))
        return {glm::vec3(0.0F), directional->direction_world};
    if (const auto* point = std::get_if<PointLight>(&light))
        return {point->position_world, glm::vec3(0.0F)};
    const auto& spot = std::get<SpotLight>(light);
    return {spot.point.position_world, spot.direction_world};
}

/// Returns whether a light of the same kind is at another place.
bool is_moved(const AnyLight& a, const AnyLight& b) {
    return type_of(a) == type_of(b) && place_of(a) != place_of(b);
}

}  // namespace

ViewerState::ViewerState(ViewOptions options)
    : options_(std::move(options)), effects_(options_.effects.requests) {}

void ViewerState::take(Loaded loaded) {
    set_error(loaded.error, loaded.refused);
    if (!loaded.composed) return;
    const bool is_new = loaded.options.model != shown_model_;
    const std::shared_ptr<const Scene> edited = scene_at_rest();
    const DebugChoices debug = options_.debug;  // The window's debug settings stay.
    options_ = std::move(loaded.options);
    options_.debug = debug;
    shown_model_ = options_.model;
    notes_ = std::move(loaded.composed->notes);
    findings_ = std::move(loaded.findings);
    const Camera camera = loaded.composed->camera;
    SceneGraph& graph = loaded.composed->graph;
    tree_ = tree_of(graph);
    playback_.take(graph, !is_new);
    if (is_new && options_.time) {
        playback_.set_playing(false);
        playback_.set_time(*options_.time);
    }
    const LightCarriers carriers{graph.directional_lights, graph.point_lights, graph.spot_lights};
    auto scene = std::make_shared<Scene>(std::move(graph.scene));
    if (has_named_default_) shade::name_default_material(*scene);
    auto read = std::make_shared<const Scene>(*scene);
    rebased_ = edited ? rebase_edits(*read_, *edited, *scene) : RebasedEdits{};
    notes_.insert(notes_.end(), rebased_.lost.begin(), rebased_.lost.end());
    if (is_new || hidden_.size() != scene->instances.size())
        hidden_.assign(scene->instances.size(), false);
    replace(std::move(scene));
    light_rows_.update(*scene_, carriers);
    read_ = std::move(read);
    // Earlier states are those of the scene as it was read before.
    undo_.clear();
    redo_.clear();
    end_edit_step();
    edit_error_.clear();
    ++scenes_;
    bounds_ = world_bounds(*scene_);
    sphere_ = bounding_sphere(bounds_);
    grid_ = grid_below(bounds_);
    const BoundingSphere before = fitted_;
    measure_reach();
    mark_health();
    if (is_new) {
        const std::optional<CameraOption>& view = options_.camera;
        camera_ = view && view->place
                      ? orbit_of(*view, *view->place, camera.vertical_fov, options_.orthographic)
                      : orbit_of(camera, sphere_);
        // The scene was framed in its first pose; with --time, the window shows one pose.
        const bool is_framed =
            !(view && view->place) && !loaded.composed->camera_follows_scene && !options_.time;
        if (is_framed) {
            camera_.target += fitted_.center - sphere_.center;
            camera_.distance *= fitted_.radius / sphere_.radius;
        }
        fitting_ = is_framed ? std::optional(camera_) : std::nullopt;
        followed_.reset();
        if (loaded.composed->camera_follows_scene && playback_.camera()) followed_ = camera_;
    } else if (fitted_.center != before.center || fitted_.radius != before.radius) {
        fitting_.reset();  // The camera stays, and the model that it fitted is another one.
    }
    if (playback_.has_motion()) {
        move_to(playback_.time());
    } else {
        show_all_but_hidden();  // The size of markers is that of the new scene.
    }
}

void ViewerState::measure_reach() {
    const Bounds& reach = playback_.reach();
    reach_ =
        reach.empty()
            ? sphere_
            : bounding_sphere({glm::min(bounds_.min, reach.min), glm::max(bounds_.max, reach.max)});
    // A model that moves far away would be small for most of the time.
    constexpr float max_growth = 4.0F;
    fitted_ = reach_.radius <= max_growth * sphere_.radius ? reach_ : sphere_;
}

void ViewerState::show_clip() {
    const BoundingSphere before = fitted_;
    measure_reach();
    if (!fitting_ || *fitting_ != camera_) return;
    camera_.target += fitted_.center - before.center;
    camera_.distance *= fitted_.radius / before.radius;
    fitting_ = camera_;
}

ViewerState::EditState ViewerState::edit_state() const {
    EditState state{scene_,
                    light_rows_,
                    {},
                    options_.environment,
                    options_.environment_layout,
                    options_.left_handed_environment};
    for (const LightRow& row : light_rows_.rows(*scene_)) {
        if (!row.carried.node) continue;
        if (const auto speed = playback_.orbit_speed(*row.carried.node))
            state.orbit_speeds.emplace_back(*row.carried.node, *speed);
    }
    return state;
}

void ViewerState::begin_edit_step() {
    if (!scene_ || std::exchange(is_step_open_, true)) return;
    if (undo_.size() == max_undo) undo_.erase(undo_.begin());
    undo_.push_back(edit_state());
    redo_.clear();
}

void ViewerState::restore(EditState state) {
    light_rows_ = std::move(state.light_rows);
    for (const auto& [node, speed] : state.orbit_speeds) {
        if (playback_.orbit_speed(node) != speed) playback_.set_orbit_speed(node, speed);
    }
    options_.environment = std::move(state.environment);
    options_.environment_layout = state.environment_layout;
    options_.left_handed_environment = state.left_handed_environment;
    edit_error_.clear();
    replace(std::move(state.scene));
    if (playback_.has_motion()) move_to(playback_.time());
}

/// Shows the last state of a list, and adds the current one to the other.
void ViewerState::exchange_edits(std::vector<EditState>& from, std::vector<EditState>& to) {
    end_edit_step();
    if (!scene_ || from.empty()) return;
    to.push_back(edit_state());
    EditState state = std::move(from.back());
    from.pop_back();
    restore(std::move(state));
}

/// Replaces the scene, and updates the scene without hidden instances.
void ViewerState::replace(std::shared_ptr<const Scene> scene) {
    scene_ = std::move(scene);
    show_all_but_hidden();
    ++revision_;
}

void ViewerState::show_all_but_hidden() {
    shown_ = scene_;
    if (std::find(hidden_.begin(), hidden_.end(), true) != hidden_.end()) {
        auto shown = std::make_shared<Scene>(*scene_);
        shown->instances.clear();
        for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
            if (is_shown(i)) shown->instances.push_back(scene_->instances[i]);
        }
        shown_ = std::move(shown);
    }
    if (!has_light_markers_) return;
    SceneGraph marked;
    marked.scene = *shown_;
    add_light_markers(marked, marker_share * sphere_.radius);
    shown_ = std::make_shared<Scene>(std::move(marked.scene));
}

/// Moves instances and lights, which draws the scene without preparing it again.
template <typename Change>
void ViewerState::move(const Change& change) {
    auto moved = std::make_shared<Scene>(*scene_);
    change(*moved);
    scene_ = std::move(moved);
    show_all_but_hidden();
    ++pose_;
}

void ViewerState::move_to(double seconds) {
    move([&](Scene& scene) { playback_.pose(scene, light_rows_.carriers(), seconds); });
    if (playback_.moves_materials()) ++revision_;  // The scene may need other effects.
    follow_camera();
}

/// Shows the camera of the animation, unless the user has moved it.
void ViewerState::follow_camera() {
    const std::optional<Camera> camera = playback_.camera();
    if (!camera || !followed_ || *followed_ != camera_) return followed_.reset();
    camera_ = orbit_of(*camera, sphere_);
    followed_ = camera_;
}

std::shared_ptr<const Scene> ViewerState::scene_at_rest() {
    if (!scene_ || !playback_.has_motion()) return scene_;
    auto scene = std::make_shared<Scene>(*scene_);
    playback_.pose(*scene, light_rows_.carriers(), options_.time.value_or(0.0));
    return scene;
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
    shade::name_default_material(*read);
    read_ = std::move(read);
    edit(shade::name_default_material);
    // Earlier states have no such material.
    undo_.clear();
    end_edit_step();
}

void ViewerState::set_environment(const std::filesystem::path& file) {
    ViewOptions options;
    options.environment = {file};
    try_edit([&](Scene& scene) {
        Environment environment = environment_of(options);
        environment.lights |= std::any_of(
            scene.materials.begin(), scene.materials.end(), [](const Material& material) {
                return model_of(material) == ShadingModel::metallic_roughness;
            });
        if (scene.environment) {
            environment.intensity = scene.environment->intensity;
            environment.rotation = scene.environment->rotation;
            environment.skybox = scene.environment->skybox;
            environment.skybox_blur = scene.environment->skybox_blur;
            environment.lights = scene.environment->lights;
        }
        scene.environment = std::move(environment);
    });
    if (!edit_error_.empty()) return;
    options_.environment = options.environment;
    options_.environment_layout.reset();
    options_.left_handed_environment = false;
}

std::vector<LightRow> ViewerState::light_rows() const {
    if (!scene_) return {};
    std::vector<LightRow> rows = light_rows_.rows(*scene_);
    for (LightRow& row : rows) {
        if (!row.carried.node) continue;
        if (const auto speed = playback_.orbit_speed(*row.carried.node)) row.speed = *speed;
    }
    return rows;
}

void ViewerState::set_light_rows(std::vector<LightRow> rows) {
    begin_edit_step();
    const std::vector<LightRow> before = light_rows();
    for (LightRow& row : rows) {
        const auto old = std::find_if(before.begin(), before.end(),
                                      [&](const LightRow& one) { return one.id == row.id; });
        if (old == before.end() || !row.carried.node) continue;
        const std::size_t node = *row.carried.node;
        const bool orbits = playback_.orbit_speed(node).has_value();
        if (orbits && row.speed != old->speed) playback_.set_orbit_speed(node, row.speed);
        // A light that is moved by hand, or that rotates by itself, leaves its node.
        if (is_moved(row.light, old->light) || (!orbits && row.speed != old->speed))
            row.carried = {};
        if (orbits) row.speed = 0.0F;  // The node moves the light.
    }
    edit([&](Scene& scene) { light_rows_.set(scene, std::move(rows)); });
}

void ViewerState::orbit_lights(const glm::vec2& pixels) {
    if (!scene_ || view_.y == 0) return;
    begin_edit_step();
    const float unit = 2.0F * quarter / static_cast<float>(view_.y);
    const glm::vec3 right(std::cos(camera_.azimuth), 0.0F, -std::sin(camera_.azimuth));
    glm::mat4 rotation = glm::rotate(glm::mat4(1.0F), unit * pixels.y, right);
    rotation = glm::rotate(rotation, unit * pixels.x, {0.0F, 1.0F, 0.0F});
    light_rows_.detach_all();
    edit([&](Scene& scene) {
        std::vector<AnyLight> lights = lights_of(scene);
        for (AnyLight& light : lights)
            tools::turn(light, glm::mat3(rotation), sphere_.center);
        tools::set_lights(scene, lights);
    });
}

void ViewerState::turn_environment(float pixels) {
    if (!scene_ || !scene_->environment || view_.y == 0) return;
    edit([&](Scene& scene) {
        const float unit = 2.0F * quarter / static_cast<float>(view_.y);
        scene.environment->rotation =
            std::remainder(scene.environment->rotation + unit * pixels, 4.0F * quarter);
    });
}

void ViewerState::set_error(std::string error, std::optional<MapKind> refused) {
    error_ = std::move(error);
    refused_ = refused;
}

void ViewerState::set_map(std::size_t material, TextureSlot slot, const std::filesystem::path& file,
                          const AssumedKinds& assumed) {
    try_edit([&](Scene& scene) {
        try {
            tools::set_map(scene, material, slot, file, assumed);
        } catch (const RefusedMap& error) {
            refused_edit_.reset();
            if (error.wanted()) refused_edit_ = {material, slot, file, *error.wanted()};
            throw;
        }
    });
}

void ViewerState::set_map(std::size_t material, TextureSlot slot,
                          const std::filesystem::path& file) {
    set_map(material, slot, file, options_.assumed);
}

bool ViewerState::has_refused_map() const {
    if (!error_.empty()) return refused_.has_value();
    return !edit_error_.empty() && refused_edit_;
}

std::optional<MapKind> ViewerState::use_refused_map() {
    if (!has_refused_map()) return std::nullopt;
    if (!error_.empty()) return refused_;
    const RefusedEdit refused = *refused_edit_;
    set_map(refused.material, refused.slot, refused.file, {refused.wanted});
    return std::nullopt;
}

void ViewerState::aim(const glm::vec2& pointer) {
    if (!scene_) return;
    const Ray ray = ray_through(camera_of(camera_, sphere_), pointer);
    if (const std::optional<glm::vec3> point = surface_hit(*shown_, ray)) aim_at(camera_, *point);
}

void ViewerState::apply_view_text(const std::string& text) {
    set_error("");
    try {
        const ViewText view = parse_view_text(text);
        const float fov = view.vertical_fov.value_or(camera_.vertical_fov);
        // Without a target, the place and the projection stay.
        const CameraPlace place =
            view.camera.place.value_or(CameraPlace{camera_.target, camera_.distance});
        const bool keeps = !view.camera.place && camera_.orthographic;
        camera_ = orbit_of(view.camera, place, fov, view.orthographic || keeps);
    } catch (const UsageError& error) {
        set_error(error.what());
    }
}

void ViewerState::set_effects(EffectRequest effects) {
    effects_ = std::move(effects);
    ++revision_;
}

void ViewerState::set_shaders(const std::shared_ptr<const ShaderTexts>& texts,
                              const PictureStep* step) {
    const bool is_same_step = step == nullptr ? !step_ : step_ && step_->name == step->name;
    if (texts == shaders_ && is_same_step) return;
    shaders_ = texts;
    step_.reset();
    if (step != nullptr) step_ = *step;
    ++revision_;
}

void ViewerState::choose_camera(std::size_t index) {
    playback_.choose_camera(index);
    move_to(playback_.time());
    camera_ = orbit_of(playback_.shown_camera(), sphere_);
    followed_.reset();
    if (playback_.camera()) followed_ = camera_;
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
    if (!found.error.empty()) set_error(found.error);
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
    if (action == Action::grid) choices.grid = !choices.grid;
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
            fit(camera_, fitted_, aspect);
            fitting_ = camera_;
            return;
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
        case Action::orthographic:
            camera_.orthographic = !camera_.orthographic;
            return;
        case Action::brighter:
        case Action::darker:
            return edit([&](Scene& scene) {
                const float factor = std::exp2(action == Action::brighter ? 0.5F : -0.5F);
                scene.exposure = std::clamp(scene.exposure * factor, min_exposure, max_exposure);
            });
        case Action::undo:
            return exchange_edits(undo_, redo_);
        case Action::redo:
            return exchange_edits(redo_, undo_);
        case Action::turntable:
            is_turning_ = !is_turning_;
            return;
        case Action::play:
            return playback_.set_playing(!playback_.is_playing());
        case Action::step_back:
        case Action::step_forward:
            if (!playback_.has_motion()) return;
            return change_playback([&](Playback& playback) {
                playback.step(action == Action::step_back ? -step_seconds : step_seconds);
            });
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
        case Action::grid:
        case Action::vertex_frames:
        case Action::health_markers:
            return act_on_debug(action);
        case Action::light_markers:
            has_light_markers_ = !has_light_markers_;
            if (scene_) replace(scene_);
            return;
        default:
            return;  // The window handles the other actions.
    }
}

void ViewerState::set_view(const glm::ivec2& pixels) {
    view_ = pixels;
}

bool ViewerState::advance(double seconds) {
    if (!scene_) return false;
    const bool is_playing = playback_.advance(seconds);
    if (is_playing) move_to(playback_.time());
    if (light_rows_.is_moving())
        move([&](Scene& scene) { light_rows_.advance(scene, seconds, sphere_.center); });
    if (!is_turning_) return is_playing || light_rows_.is_moving();
    camera_.azimuth = std::remainder(
        camera_.azimuth - turntable_speed * static_cast<float>(seconds), 4.0F * quarter);
    return true;
}

std::optional<DrawRequest> ViewerState::request() const {
    if (!scene_ || view_.x <= 0 || view_.y <= 0) return std::nullopt;
    DrawRequest request;
    request.scene = shown_;
    request.revision = revision_;
    request.pose = pose_;
    request.effects = effects_;
    request.settings.width = view_.x;
    request.settings.height = view_.y;
    request.settings.samples = options_.samples;
    request.settings.view = options_.debug.view;
    request.settings.overlays = overlays_of(options_.debug, markers_, grid_);
    request.settings.shaders = shaders_;
    request.camera = camera_of(camera_, reach_);
    if (step_) {
        request.effects = step_->request;
        request.scene = std::make_shared<const Scene>(scene_of_step(*shown_, *step_));
    }
    return request;
}

std::string ViewerState::command_line() const {
    return fmt::format("--camera {} --fov {}{} --size {}x{}", to_text(camera_),
                       degrees_text(camera_.vertical_fov),
                       camera_.orthographic ? " --orthographic" : "", view_.x, view_.y) +
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
                                      {"fov", glm::degrees(camera_.vertical_fov)},
                                      {"orthographic", camera_.orthographic}}},
                                    {"show", debug_view_info(options_.debug.view).name},
                                    {"overlays", overlays_json(options_.debug, markers_)},
                                    {"light_markers", has_light_markers_},
                                    {"turntable", is_turning_},
                                    {"animation", playback_.json()},
                                    {"scenes", scenes_},
                                    {"edits",
                                     {{"kept", rebased_.kept},
                                      {"lost", rebased_.lost},
                                      {"undo", undo_.size()},
                                      {"redo", redo_.size()}}},
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
    state["shown"] = {std::count(hidden_.begin(), hidden_.end(), false), hidden_.size()};
    state["materials"] = scene_->materials.size();
    nlohmann::json lights = nlohmann::json::array();
    for (const DirectionalLight& light : scene_->directional_lights)
        lights.push_back(numbers(light.direction_world));
    state["directional_lights"] = lights;
    state["lights"] = nlohmann::json::array();
    for (const LightRow& row : light_rows()) {
        state["lights"].push_back(
            {{"kind", enum_name(type_of(row.light))}, {"speed", glm::degrees(row.speed)}});
    }
    if (drawn.plan) state["effects"] = effects_in(*drawn.plan);
    return state;
}

}  // namespace relief::tools
