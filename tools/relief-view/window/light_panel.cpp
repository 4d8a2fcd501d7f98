// SPDX-License-Identifier: Apache-2.0
// The panel that edits lights. Tests: tests/tools/window/light_panel_test.cpp.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "light_options.h"
#include "relief/shade/scene_fields.h"
#include "window/controls.h"
#include "window/edit_panels.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

constexpr float light_distance = 2.0F;  // In radii of the sphere.
const glm::vec3 upper_right = glm::normalize(glm::vec3(0.6F, 0.8F, 0.6F));

/// The light that arrives at the center of the sphere.
struct Illumination {
    glm::vec3 from{0.0F, 1.0F, 0.0F};  ///< Unit vector towards the light.
    glm::vec3 irradiance{1.0F};
    std::optional<glm::vec3> highlight;
    glm::vec3 ambient{0.0F};
    bool on = true;
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
        return {normalized_or_up(-far->direction_world), far->irradiance, far->highlight_irradiance,
                far->ambient, far->on};
    const auto* spot = std::get_if<SpotLight>(&light);
    const PointLight& point = spot != nullptr ? spot->point : std::get<PointLight>(light);
    const glm::vec3 offset = point.position_world - sphere.center;
    const float falloff = falloff_at(point, glm::length(offset));
    Illumination illumination{
        normalized_or_up(offset), falloff * point.intensity, {}, point.ambient, point.on};
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
    light.ambient = illumination.ambient;
    light.on = illumination.on;
    return light;
}

SpotLight spot_at(const PointLight& point, const BoundingSphere& sphere) {
    SpotLight spot;
    spot.point = point;
    spot.direction_world = -normalized_or_up(point.position_world - sphere.center);
    return spot;
}

}  // namespace

LightType type_of(const AnyLight& light) {
    return static_cast<LightType>(light.index());
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

AnyLight new_light(LightType type, const BoundingSphere& sphere) {
    DirectionalLight light;
    light.direction_world = -upper_right;
    return converted_to(light, type, sphere);
}

AnyLight converted_to(const AnyLight& light, LightType type, const BoundingSphere& sphere) {
    if (type == type_of(light)) return light;
    const Illumination illumination = illumination_of(light, sphere);
    if (type == LightType::directional)
        return DirectionalLight{-illumination.from,
                                glm::min(illumination.irradiance, glm::vec3(max_light)),
                                illumination.highlight, illumination.ambient, illumination.on};
    // Point lights and spotlights keep their position, range and falloff.
    PointLight point = point_light_for(illumination, sphere);
    if (const auto* spot = std::get_if<SpotLight>(&light)) point = spot->point;
    if (const auto* own = std::get_if<PointLight>(&light)) point = *own;
    if (type == LightType::point) return point;
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

namespace {

const std::vector<Carried>& of_type(const LightCarriers& carriers, LightType type) {
    return type == LightType::directional ? carriers.directional
           : type == LightType::point     ? carriers.point
                                          : carriers.spot;
}

}  // namespace

void LightRows::update(const Scene& scene, const LightCarriers& carriers) {
    std::vector<Entry> now;
    std::array<std::size_t, 3> counts{};  // Of the lights of each kind.
    for (const AnyLight& light : lights_of(scene)) {
        const LightType type = type_of(light);
        const std::size_t place = counts[static_cast<std::size_t>(type)]++;
        const std::vector<Carried>& nodes = of_type(carriers, type);
        const Carried carried = place < nodes.size() ? nodes[place] : Carried{};
        const auto same = std::find_if(entries_.begin(), entries_.end(),
                                       [&](const Entry& entry) { return entry.type == type; });
        if (same == entries_.end()) {
            now.push_back({type, ++last_id_, 0.0F, carried});
        } else {
            now.push_back(*same);
            now.back().carried = same->is_detached ? Carried{} : carried;
            entries_.erase(same);
        }
    }
    entries_ = std::move(now);
}

std::vector<LightRow> LightRows::rows(const Scene& scene) const {
    const std::vector<AnyLight> lights = lights_of(scene);
    std::vector<LightRow> rows;
    for (std::size_t i = 0; i < std::min(lights.size(), entries_.size()); ++i)
        rows.push_back({lights[i], entries_[i].id, entries_[i].speed, entries_[i].carried});
    return rows;
}

LightCarriers LightRows::carriers() const {
    LightCarriers carriers;
    for (const Entry& entry : entries_) {
        std::vector<Carried>& of_kind = entry.type == LightType::directional ? carriers.directional
                                        : entry.type == LightType::point     ? carriers.point
                                                                             : carriers.spot;
        of_kind.push_back(entry.carried);
    }
    return carriers;
}

void LightRows::detach_all() {
    for (Entry& entry : entries_) {
        entry.is_detached |= entry.carried.node.has_value();
        entry.carried = {};
    }
}

void LightRows::set(Scene& scene, std::vector<LightRow> rows) {
    std::stable_sort(rows.begin(), rows.end(), [](const LightRow& a, const LightRow& b) {
        return type_of(a.light) < type_of(b.light);
    });
    const std::vector<Entry> before = std::exchange(entries_, {});
    std::vector<AnyLight> lights;
    for (const LightRow& row : rows) {
        const auto known = std::find_if(before.begin(), before.end(),
                                        [&](const Entry& entry) { return entry.id == row.id; });
        const bool was_attached =
            known != before.end() && (known->is_detached || known->carried.node);
        entries_.push_back({type_of(row.light), row.id != 0 ? row.id : ++last_id_, row.speed,
                            row.carried, was_attached && !row.carried.node});
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

/// Edits a color as a normalized color and an intensity, in rows of these names.
bool edit_light_color(glm::vec3& irradiance, const char* color_label = "Color",
                      const char* intensity_label = "Intensity") {
    float strength = std::max({irradiance.x, irradiance.y, irradiance.z});
    glm::vec3 color = strength > 0.0F ? irradiance / strength : glm::vec3(1.0F);
    bool changed = pick_color(color_label, color);
    changed |= drag_up(intensity_label, strength);
    if (changed) irradiance = std::max(strength, 0.0F) * glm::max(color, glm::vec3(0.0F));
    return changed;
}

/// Edits the color of highlights, if it is not that of the light.
bool edit_highlights(std::optional<glm::vec3>& highlight, const glm::vec3& light) {
    bool has_own = highlight.has_value();
    bool changed = check("Own highlight color", has_own);
    if (changed) highlight = has_own ? std::optional(light) : std::nullopt;
    if (!highlight) return changed;
    return edit_light_color(*highlight, "Highlight color", "Highlight intensity") || changed;
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

/// Edits what all lights have in common: whether it is on, and its ambient light.
template <typename Light>
bool edit_common(Light& light) {
    const bool changed = check("On", light.on);
    return pick_color("Ambient", light.ambient, false) || changed;
}

bool edit_point(PointLight& light) {
    constexpr float room = 14.5F;  // For three numbers, in line heights.
    bool changed = ImGui::DragFloat3(begin_row("Position", room).c_str(), &light.position_world.x,
                                     0.01F, 0.0F, 0.0F, "%.2f");
    probe_item("Position");
    changed |= edit_light_color(light.intensity);
    changed |= edit_highlights(light.highlight_intensity, light.intensity);
    bool falls_off = light.falloff == Falloff::inverse_square;
    if (check("Falloff", falls_off)) {
        light.falloff = falls_off ? Falloff::inverse_square : Falloff::none;
        changed = true;
    }
    return edit_common(light) || changed;
}

/// Edits the cone angles. The inner cone stays smaller than the outer cone.
bool edit_cones(SpotLight& light) {
    float inner = glm::degrees(light.inner_cone);
    float outer = glm::degrees(light.outer_cone);
    bool changed = slide("Outer cone", outer, {1.0F, 90.0F, "%.0f deg"});
    changed |= slide("Inner cone", inner, {0.0F, 90.0F, "%.0f deg"});
    if (!changed) return false;
    light.outer_cone = std::clamp(glm::radians(outer), 0.01F, outer_cone_field.range.max);
    light.inner_cone = std::clamp(glm::radians(inner), 0.0F, 0.99F * light.outer_cone);
    return true;
}

bool edit_light(AnyLight& light) {
    if (auto* directional = std::get_if<DirectionalLight>(&light)) {
        bool changed = edit_direction(directional->direction_world);
        changed |= edit_light_color(directional->irradiance);
        changed |= edit_common(*directional);
        return edit_highlights(directional->highlight_irradiance, directional->irradiance) ||
               changed;
    }
    if (auto* point = std::get_if<PointLight>(&light)) return edit_point(*point);
    auto& spot = std::get<SpotLight>(light);
    bool changed = edit_point(spot.point);
    changed |= edit_direction(spot.direction_world);
    return edit_cones(spot) || changed;
}

/// Edits the kind, the parameters and the rotation. \return whether anything changed
bool edit_row(LightRow& row, const BoundingSphere& sphere) {
    LightType type = type_of(row.light);
    bool changed = choose("Kind", type);
    if (changed) row.light = converted_to(row.light, type, sphere);
    changed |= edit_light(row.light);
    if (row.carried.node) ImGui::TextDisabled("Its node moves it, until it is moved here.");
    changed |= slide_angle("Rotation", row.speed, {-180.0F, 180.0F, "%.0f deg/s"});
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
            ImGui::TreeNode("light", "%s, %s", name.c_str(), enum_name(type_of(rows[i].light)));
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
    for (const EnumName<LightType>& type : enum_names<LightType>) {
        ImGui::SameLine();
        if (ImGui::Button(type.name)) {
            rows.push_back({new_light(type.value, sphere)});
            changed = true;
        }
        probe_item(fmt::format("Add {}", type.name));
    }
    return changed;
}

}  // namespace

void draw_light_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    std::vector<LightRow> rows = state.light_rows();
    glm::vec3 ambient = state.scene().ambient;
    if (pick_color("Ambient", ambient, false)) {
        state.edit([&](Scene& scene) { scene.ambient = glm::max(ambient, glm::vec3(0.0F)); });
    }
    bool clamps = state.scene().clamp_terms;
    if (check("Clamp terms", clamps)) {
        state.edit([&](Scene& scene) { scene.clamp_terms = clamps; });
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("Phong's surfaces clamp each term to 0 to 1 before they add it.");
    std::optional<Shadow> shadow = state.scene().shadow;
    bool casts = shadow.has_value();
    if (check("Shadow", casts)) {
        shadow = casts ? std::optional(Shadow()) : std::nullopt;
        state.edit([&](Scene& scene) { scene.shadow = shadow; });
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip(
            "The first directional light casts it, else the first spot or point light.");
    if (shadow && edit_field(*shadow, &Shadow::size))
        state.edit([&](Scene& scene) { scene.shadow = shadow; });
    const bool has_changed = edit_rows(rows, state.sphere());
    const bool has_more = add_rows(rows, state.sphere());
    if (has_changed || has_more) state.set_light_rows(std::move(rows));
}

}  // namespace relief::tools
