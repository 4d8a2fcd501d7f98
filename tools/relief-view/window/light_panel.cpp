// SPDX-License-Identifier: Apache-2.0
// Lights: their kinds, directions, places, colours and strengths; adding and removing them.
// Tests: tests/tools/window/window_test.cpp.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

/// A colour is a strength and what is left of it.
bool edit_light_color(glm::vec3& irradiance) {
    float strength = std::max({irradiance.x, irradiance.y, irradiance.z});
    glm::vec3 color = strength > 0.0F ? irradiance / strength : glm::vec3(1.0F);
    bool changed = ImGui::ColorEdit3("Colour", &color.x, ImGuiColorEditFlags_Float);
    changed |= ImGui::DragFloat("Intensity", &strength, 0.01F, 0.0F, 1e6F, "%.3g");
    if (changed) irradiance = std::max(strength, 0.0F) * glm::max(color, glm::vec3(0.0F));
    return changed;
}

bool edit_direction(glm::vec3& travels) {
    const glm::vec3 from = -glm::normalize(travels);
    float azimuth = glm::degrees(std::atan2(from.x, from.z));
    float elevation = glm::degrees(std::asin(std::clamp(from.y, -1.0F, 1.0F)));
    bool changed = ImGui::SliderFloat("Azimuth", &azimuth, -180.0F, 180.0F, "%.0f deg");
    changed |= ImGui::SliderFloat("Elevation", &elevation, -90.0F, 90.0F, "%.0f deg");
    if (changed) {
        const float a = glm::radians(azimuth);
        const float e = glm::radians(elevation);
        travels = -glm::vec3(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
    }
    return changed;
}

/// One light: its values, and a button that removes it. \return whether anything changed
template <typename Light, typename Draw>
bool edit_lights(const char* kind, std::vector<Light>& lights, const Draw& draw) {
    bool changed = false;
    std::optional<std::size_t> removed;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        ImGui::PushID(kind);
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::TreeNode("light", "%s light %zu", kind, i + 1)) {
            changed |= draw(lights[i]);
            if (ImGui::Button("Remove")) removed = i;
            ImGui::TreePop();
        }
        ImGui::PopID();
        ImGui::PopID();
    }
    if (removed) lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(*removed));
    return changed || removed;
}

}  // namespace

void draw_light_panel(const PanelInput& input) {
    if (!input.state.has_scene()) return;
    std::vector<DirectionalLight> directional = input.state.scene().directional_lights;
    std::vector<PointLight> points = input.state.scene().point_lights;
    std::vector<SpotLight> spots = input.state.scene().spot_lights;
    glm::vec3 ambient = input.state.scene().ambient;
    bool changed = ImGui::ColorEdit3("Ambient", &ambient.x,
                                     ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
    changed |= edit_lights("Directional", directional, [](DirectionalLight& light) {
        const bool turned = edit_direction(light.direction_world);
        return edit_light_color(light.irradiance) || turned;
    });
    const auto edit_place = [](PointLight& light) {
        const bool moved = ImGui::DragFloat3("Position", &light.position_world.x, 0.01F);
        return edit_light_color(light.intensity) || moved;
    };
    changed |= edit_lights("Point", points, edit_place);
    changed |= edit_lights("Spot", spots, [&](SpotLight& light) {
        bool edited = edit_place(light.point);
        edited |= edit_direction(light.direction_world);
        float cone = glm::degrees(light.outer_cone);
        if (ImGui::SliderFloat("Cone", &cone, 1.0F, 90.0F, "%.0f deg")) {
            light.outer_cone = glm::radians(cone);
            light.inner_cone = std::min(light.inner_cone, 0.99F * light.outer_cone);
            edited = true;
        }
        return edited;
    });
    const Ball& ball = input.state.ball();
    if (ImGui::Button("Add directional")) {
        directional.push_back({});
        changed = true;
    }
    mark_place("Add directional");
    ImGui::SameLine();
    if (ImGui::Button("Add point")) {
        PointLight light;
        light.position_world = ball.center + ball.radius * glm::vec3(0.7F, 1.0F, 0.7F);
        light.intensity = glm::vec3(ball.radius * ball.radius);
        points.push_back(light);
        changed = true;
    }
    if (!changed) return;
    input.state.edit([&](Scene& scene) {
        scene.directional_lights = directional;
        scene.point_lights = points;
        scene.spot_lights = spots;
        scene.ambient = glm::max(ambient, glm::vec3(0.0F));
    });
}

}  // namespace relief::tools
