// SPDX-License-Identifier: Apache-2.0
#include "window/light_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

#include "view_options.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
namespace {

constexpr float light_distance = 2.0F;  // In radii of the sphere.
const glm::vec3 upper_right = glm::normalize(glm::vec3(0.6F, 0.8F, 0.6F));

/// The light that arrives at the center of the sphere.
struct Illumination {
    glm::vec3 from{0.0F, 1.0F, 0.0F};  ///< Unit vector towards the light.
    glm::vec3 irradiance{1.0F};
    std::optional<glm::vec3> highlight;
};

glm::vec3 normalized_or_up(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0.0F ? v / length : glm::vec3(0.0F, 1.0F, 0.0F);
}

/// The falloff at a distance, relative to distance 1.
float falloff_at(const PointLight& light, float distance) {
    if (light.falloff == Falloff::none) return 1.0F;
    return 1.0F / std::max(distance * distance, 1e-12F);
}

/// The light that arrives from a light. A spotlight counts with its axis value, because a
/// conversion turns it towards the center.
Illumination illumination_of(const AnyLight& light, const BoundingSphere& sphere) {
    if (const auto* far = std::get_if<DirectionalLight>(&light))
        return {normalized_or_up(-far->direction_world), far->irradiance,
                far->highlight_irradiance};
    const auto* spot = std::get_if<SpotLight>(&light);
    const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(light);
    const glm::vec3 offset = point.position_world - sphere.center;
    const float falloff = falloff_at(point, glm::length(offset));
    Illumination illumination{normalized_or_up(offset), falloff * point.intensity, {}};
    if (point.highlight_intensity) illumination.highlight = falloff * *point.highlight_intensity;
    return illumination;
}

PointLight point_light_for(const Illumination& illumination, const BoundingSphere& sphere) {
    const float distance = light_distance * sphere.radius;
    PointLight light;
    light.position_world = sphere.center + distance * illumination.from;
    const auto bounded = [&](const glm::vec3& irradiance) {
        return glm::min(distance * distance * irradiance, glm::vec3(max_light));
    };
    light.intensity = bounded(illumination.irradiance);
    if (illumination.highlight) light.highlight_intensity = bounded(*illumination.highlight);
    return light;
}

SpotLight spot_at(const PointLight& point, const BoundingSphere& sphere) {
    SpotLight spot;
    spot.point = point;
    spot.direction_world = -normalized_or_up(point.position_world - sphere.center);
    return spot;
}

}  // namespace

LightKind kind_of(const AnyLight& light) {
    return static_cast<LightKind>(light.index());
}

const char* name_of(LightKind kind) {
    if (kind == LightKind::directional) return "directional";
    return kind == LightKind::point ? "point" : "spot";
}

std::vector<AnyLight> lights_of(const Scene& scene) {
    std::vector<AnyLight> lights(scene.directional_lights.begin(), scene.directional_lights.end());
    lights.insert(lights.end(), scene.point_lights.begin(), scene.point_lights.end());
    lights.insert(lights.end(), scene.spot_lights.begin(), scene.spot_lights.end());
    return lights;
}

void set_lights(Scene& scene, const std::vector<AnyLight>& lights) {
    scene.directional_lights.clear();
    scene.point_lights.clear();
    scene.spot_lights.clear();
    for (const AnyLight& light : lights) {
        if (const auto* directional = std::get_if<DirectionalLight>(&light))
            scene.directional_lights.push_back(*directional);
        else if (const auto* point = std::get_if<PointLight>(&light))
            scene.point_lights.push_back(*point);
        else
            scene.spot_lights.push_back(std::get<SpotLight>(light));
    }
}

AnyLight new_light(LightKind kind, const BoundingSphere& sphere) {
    DirectionalLight light;
    light.direction_world = -upper_right;
    return converted_to(light, kind, sphere);
}

AnyLight converted_to(const AnyLight& light, LightKind kind, const BoundingSphere& sphere) {
    if (kind == kind_of(light)) return light;
    const Illumination illumination = illumination_of(light, sphere);
    if (kind == LightKind::directional)
        return DirectionalLight{-illumination.from,
                                glm::min(illumination.irradiance, glm::vec3(max_light)),
                                illumination.highlight};
    // Point lights and spotlights keep their position, range and falloff.
    PointLight point = point_light_for(illumination, sphere);
    if (const auto* spot = std::get_if<SpotLight>(&light)) point = spot->point;
    if (const auto* own = std::get_if<PointLight>(&light)) point = *own;
    if (kind == LightKind::point) return point;
    return spot_at(point, sphere);
}

void turn(AnyLight& light, const glm::mat3& rotation, const glm::vec3& center) {
    const auto move = [&](PointLight& point) {
        point.position_world = center + rotation * (point.position_world - center);
    };
    if (auto* directional = std::get_if<DirectionalLight>(&light)) {
        directional->direction_world = rotation * directional->direction_world;
    } else if (auto* point = std::get_if<PointLight>(&light)) {
        move(*point);
    } else {
        auto& spot = std::get<SpotLight>(light);
        move(spot.point);
        spot.direction_world = rotation * spot.direction_world;
    }
}

void LightRows::update(const Scene& scene) {
    std::vector<Entry> now;
    for (const AnyLight& light : lights_of(scene)) {
        const LightKind kind = kind_of(light);
        const auto same = std::find_if(entries_.begin(), entries_.end(),
                                       [&](const Entry& entry) { return entry.kind == kind; });
        if (same == entries_.end()) {
            now.push_back({kind, ++last_id_, 0.0F});
        } else {
            now.push_back(*same);
            entries_.erase(same);
        }
    }
    entries_ = std::move(now);
}

std::vector<LightRow> LightRows::rows(const Scene& scene) const {
    const std::vector<AnyLight> lights = lights_of(scene);
    std::vector<LightRow> rows;
    for (std::size_t i = 0; i < std::min(lights.size(), entries_.size()); ++i)
        rows.push_back({lights[i], entries_[i].id, entries_[i].speed});
    return rows;
}

void LightRows::set(Scene& scene, std::vector<LightRow> rows) {
    std::stable_sort(rows.begin(), rows.end(), [](const LightRow& a, const LightRow& b) {
        return kind_of(a.light) < kind_of(b.light);
    });
    entries_.clear();
    std::vector<AnyLight> lights;
    for (const LightRow& row : rows) {
        entries_.push_back({kind_of(row.light), row.id != 0 ? row.id : ++last_id_, row.speed});
        lights.push_back(row.light);
    }
    set_lights(scene, lights);
}

bool LightRows::is_moving() const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [](const Entry& entry) { return entry.speed != 0.0F; });
}

void LightRows::advance(Scene& scene, double seconds, const glm::vec3& center) const {
    std::vector<LightRow> moved = rows(scene);
    std::vector<AnyLight> lights;
    for (LightRow& row : moved) {
        const float angle = row.speed * static_cast<float>(seconds);
        if (angle != 0.0F) {
            const glm::mat4 rotation = glm::rotate(glm::mat4(1.0F), angle, {0.0F, 1.0F, 0.0F});
            turn(row.light, glm::mat3(rotation), center);
        }
        lights.push_back(row.light);
    }
    set_lights(scene, lights);
}

namespace {

constexpr LightKind kinds[] = {LightKind::directional, LightKind::point, LightKind::spot};

/// Edits a color as a normalized color and an intensity.
bool edit_light_color(glm::vec3& irradiance) {
    float strength = std::max({irradiance.x, irradiance.y, irradiance.z});
    glm::vec3 color = strength > 0.0F ? irradiance / strength : glm::vec3(1.0F);
    bool changed = ImGui::ColorEdit3("Color", &color.x, ImGuiColorEditFlags_Float);
    changed |= drag_up("Intensity", strength);
    if (changed) irradiance = std::max(strength, 0.0F) * glm::max(color, glm::vec3(0.0F));
    return changed;
}

bool edit_direction(glm::vec3& direction) {
    const glm::vec3 from = -glm::normalize(direction);
    float azimuth = glm::degrees(std::atan2(from.x, from.z));
    float elevation = glm::degrees(std::asin(std::clamp(from.y, -1.0F, 1.0F)));
    bool changed = slide("Azimuth", azimuth, {-180.0F, 180.0F, "%.0f deg"});
    changed |= slide("Elevation", elevation, {-90.0F, 90.0F, "%.0f deg"});
    if (changed) direction = -towards(glm::radians(azimuth), glm::radians(elevation));
    return changed;
}

bool edit_point(PointLight& light) {
    bool changed = ImGui::DragFloat3("Position", &light.position_world.x, 0.01F);
    changed |= edit_light_color(light.intensity);
    bool falls_off = light.falloff == Falloff::inverse_square;
    if (ImGui::Checkbox("Falloff with distance", &falls_off)) {
        light.falloff = falls_off ? Falloff::inverse_square : Falloff::none;
        changed = true;
    }
    return changed;
}

/// Edits the cone angles. The inner cone stays smaller than the outer cone.
bool edit_cones(SpotLight& light) {
    float inner = glm::degrees(light.inner_cone);
    float outer = glm::degrees(light.outer_cone);
    bool changed = slide("Outer cone", outer, {1.0F, 90.0F, "%.0f deg"});
    changed |= slide("Inner cone", inner, {0.0F, 90.0F, "%.0f deg"});
    if (!changed) return false;
    light.outer_cone = std::clamp(glm::radians(outer), 0.01F, 0.5F * std::numbers::pi_v<float>);
    light.inner_cone = std::clamp(glm::radians(inner), 0.0F, 0.99F * light.outer_cone);
    return true;
}

bool edit_light(AnyLight& light) {
    if (auto* directional = std::get_if<DirectionalLight>(&light)) {
        const bool turned = edit_direction(directional->direction_world);
        return edit_light_color(directional->irradiance) || turned;
    }
    if (auto* point = std::get_if<PointLight>(&light)) return edit_point(*point);
    auto& spot = std::get<SpotLight>(light);
    bool changed = edit_point(spot.point);
    changed |= edit_direction(spot.direction_world);
    return edit_cones(spot) || changed;
}

/// Edits the kind, the parameters and the rotation. \return whether anything changed
bool edit_row(LightRow& row, const BoundingSphere& sphere) {
    LightKind kind = kind_of(row.light);
    bool changed = choose("Kind", kind, {"Directional", "Point", "Spot"});
    if (changed) row.light = converted_to(row.light, kind, sphere);
    changed |= edit_light(row.light);
    float speed = glm::degrees(row.speed);
    if (slide("Rotation", speed, {-180.0F, 180.0F, "%.0f deg/s"})) {
        row.speed = glm::radians(speed);
        changed = true;
    }
    return changed;
}

/// Edits all lights. \return whether anything changed
bool edit_rows(std::vector<LightRow>& rows, const BoundingSphere& sphere) {
    bool changed = false;
    std::optional<std::size_t> removed;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string name = fmt::format("Light {}", i + 1);
        ImGui::PushID(static_cast<int>(rows[i].id));
        const bool is_open =
            ImGui::TreeNode("light", "%s, %s", name.c_str(), name_of(kind_of(rows[i].light)));
        probe_item(name);
        if (is_open) {
            changed |= edit_row(rows[i], sphere);
            if (ImGui::Button("Remove")) removed = i;
            probe_item("Remove");
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
    if (removed) rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(*removed));
    return changed || removed;
}

bool add_rows(std::vector<LightRow>& rows, const BoundingSphere& sphere) {
    bool changed = false;
    ImGui::TextUnformatted("Add");
    for (const LightKind kind : kinds) {
        ImGui::SameLine();
        if (ImGui::Button(name_of(kind))) {
            rows.push_back({new_light(kind, sphere)});
            changed = true;
        }
        probe_item(fmt::format("Add {}", name_of(kind)));
    }
    return changed;
}

}  // namespace

void draw_light_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    std::vector<LightRow> rows = state.light_rows();
    glm::vec3 ambient = state.scene().ambient;
    bool changed = ImGui::ColorEdit3("Ambient", &ambient.x,
                                     ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
    if (changed) {
        state.edit([&](Scene& scene) { scene.ambient = glm::max(ambient, glm::vec3(0.0F)); });
    }
    const bool has_changed = edit_rows(rows, state.sphere());
    const bool has_more = add_rows(rows, state.sphere());
    if (has_changed || has_more) state.set_light_rows(std::move(rows));
}

}  // namespace relief::tools
