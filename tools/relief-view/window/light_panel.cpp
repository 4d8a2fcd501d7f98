// SPDX-License-Identifier: Apache-2.0
// Lights: their kinds, directions, places, colours, strengths and cones, how fast they go round the
// model by themselves; adding and removing them. Tests: tests/tools/window/panels_test.cpp.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light_option.h"
#include "window/controls.h"
#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

constexpr LampKind kinds[] = {LampKind::directional, LampKind::point, LampKind::spot};

/// A colour is a strength and what is left of it.
bool edit_light_color(glm::vec3& irradiance) {
    float strength = std::max({irradiance.x, irradiance.y, irradiance.z});
    glm::vec3 color = strength > 0.0F ? irradiance / strength : glm::vec3(1.0F);
    bool changed = ImGui::ColorEdit3("Colour", &color.x, ImGuiColorEditFlags_Float);
    changed |= drag_up("Intensity", strength);
    if (changed) irradiance = std::max(strength, 0.0F) * glm::max(color, glm::vec3(0.0F));
    return changed;
}

bool edit_direction(glm::vec3& travels) {
    const glm::vec3 from = -glm::normalize(travels);
    float azimuth = glm::degrees(std::atan2(from.x, from.z));
    float elevation = glm::degrees(std::asin(std::clamp(from.y, -1.0F, 1.0F)));
    bool changed = slide("Azimuth", azimuth, {-180.0F, 180.0F, "%.0f deg"});
    changed |= slide("Elevation", elevation, {-90.0F, 90.0F, "%.0f deg"});
    if (changed) travels = -towards(glm::radians(azimuth), glm::radians(elevation));
    return changed;
}

bool edit_point(PointLight& light) {
    bool changed = ImGui::DragFloat3("Position", &light.position_world.x, 0.01F);
    changed |= edit_light_color(light.intensity);
    bool falls_off = light.falloff == Falloff::inverse_square;
    if (ImGui::Checkbox("Less with distance", &falls_off)) {
        light.falloff = falls_off ? Falloff::inverse_square : Falloff::none;
        changed = true;
    }
    return changed;
}

/// Full within the inner cone, nothing beyond the outer one; the inner one stays the smaller.
bool edit_cones(SpotLight& light) {
    float inner = glm::degrees(light.inner_cone);
    float outer = glm::degrees(light.outer_cone);
    bool changed = slide("Cone", outer, {1.0F, 90.0F, "%.0f deg"});
    changed |= slide("Full within", inner, {0.0F, 90.0F, "%.0f deg"});
    if (!changed) return false;
    light.outer_cone = std::clamp(glm::radians(outer), 0.01F, 0.5F * std::numbers::pi_v<float>);
    light.inner_cone = std::clamp(glm::radians(inner), 0.0F, 0.99F * light.outer_cone);
    return true;
}

bool edit_lamp(Lamp& lamp) {
    if (auto* directional = std::get_if<DirectionalLight>(&lamp)) {
        const bool turned = edit_direction(directional->direction_world);
        return edit_light_color(directional->irradiance) || turned;
    }
    if (auto* point = std::get_if<PointLight>(&lamp)) return edit_point(*point);
    auto& spot = std::get<SpotLight>(lamp);
    bool changed = edit_point(spot.point);
    changed |= edit_direction(spot.direction_world);
    return edit_cones(spot) || changed;
}

/// The kind, what it has, its own motion. \return whether anything changed
bool edit_row(LampRow& row, const Ball& ball) {
    LampKind kind = kind_of(row.lamp);
    bool changed = choose("Kind", kind, {"Directional", "Point", "Spot"});
    if (changed) row.lamp = as_kind(row.lamp, kind, ball);
    changed |= edit_lamp(row.lamp);
    float speed = glm::degrees(row.speed);
    if (slide("Goes round", speed, {-180.0F, 180.0F, "%.0f deg/s"})) {
        row.speed = glm::radians(speed);
        changed = true;
    }
    return changed;
}

/// Each with its values, which are shown where it is opened. \return whether anything changed
bool edit_rows(std::vector<LampRow>& rows, const Ball& ball) {
    bool changed = false;
    std::optional<std::size_t> removed;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string name = fmt::format("Light {}", i + 1);
        ImGui::PushID(static_cast<int>(rows[i].id));
        const bool is_open =
            ImGui::TreeNode("light", "%s, %s", name.c_str(), name_of(kind_of(rows[i].lamp)));
        mark_place(name);
        if (is_open) {
            changed |= edit_row(rows[i], ball);
            if (ImGui::Button("Remove")) removed = i;
            mark_place("Remove");
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
    if (removed) rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(*removed));
    return changed || removed;
}

bool add_rows(std::vector<LampRow>& rows, const Ball& ball) {
    bool changed = false;
    ImGui::TextUnformatted("Add");
    for (const LampKind kind : kinds) {
        ImGui::SameLine();
        if (ImGui::Button(name_of(kind))) {
            rows.push_back({new_lamp(kind, ball)});
            changed = true;
        }
        mark_place(fmt::format("Add {}", name_of(kind)));
    }
    return changed;
}

}  // namespace

void draw_light_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    std::vector<LampRow> rows = state.lamps();
    glm::vec3 ambient = state.scene().ambient;
    bool changed = ImGui::ColorEdit3("Ambient", &ambient.x,
                                     ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
    if (changed) {
        state.edit([&](Scene& scene) { scene.ambient = glm::max(ambient, glm::vec3(0.0F)); });
    }
    const bool has_changed = edit_rows(rows, state.ball());
    const bool has_more = add_rows(rows, state.ball());
    if (has_changed || has_more) state.set_lamps(std::move(rows));
}

}  // namespace relief::tools
