// SPDX-License-Identifier: Apache-2.0
// The panels that edit lights and materials.
// Tests: tests/tools/window/light_panel_test.cpp, material_panel_test.cpp.
#include "window/edit_panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "common/map_kind.h"
#include "light_options.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/shade/frame_settings.h"
#include "view_options.h"
#include "window/panels.h"

namespace relief::tools {

// Lights.

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

/// Edits a color as a normalized color and an intensity.
bool edit_light_color(glm::vec3& irradiance) {
    float strength = std::max({irradiance.x, irradiance.y, irradiance.z});
    glm::vec3 color = strength > 0.0F ? irradiance / strength : glm::vec3(1.0F);
    bool changed = pick_color("Color", color);
    changed |= drag_up("Intensity", strength);
    if (changed) irradiance = std::max(strength, 0.0F) * glm::max(color, glm::vec3(0.0F));
    return changed;
}

/// Edits the color of highlights, if it is not that of the light.
bool edit_highlights(std::optional<glm::vec3>& highlight, const glm::vec3& light) {
    bool has_own = highlight.has_value();
    bool changed = check("Own highlight color", has_own);
    if (changed) highlight = has_own ? std::optional(light) : std::nullopt;
    if (!highlight) return changed;
    ImGui::PushID("highlights");
    changed |= edit_light_color(*highlight);
    ImGui::PopID();
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

/// Edits what all lights have in common: whether it is on, and its ambient light.
template <typename Light>
bool edit_common(Light& light) {
    const bool changed = check("On", light.on);
    return pick_color("Ambient", light.ambient, false) || changed;
}

bool edit_point(PointLight& light) {
    bool changed = ImGui::DragFloat3(begin_row("Position").c_str(), &light.position_world.x, 0.01F);
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
    if (shadow &&
        slide_angle("Shadow size", shadow->size, {.min = 0.0F, .max = 30.0F, .format = "%.1f deg"}))
        state.edit([&](Scene& scene) { scene.shadow = shadow; });
    const bool has_changed = edit_rows(rows, state.sphere());
    const bool has_more = add_rows(rows, state.sphere());
    if (has_changed || has_more) state.set_light_rows(std::move(rows));
}

// Materials.

namespace {

/// The roughness for a shininess of 2 / alpha^2 - 2, with alpha = roughness^2.
float roughness_of(float shininess) {
    return std::clamp(std::pow(2.0F / (shininess + 2.0F), 0.25F), 0.045F, 1.0F);
}

}  // namespace

ShadingModel model_of(const Material& material) {
    if (material.unlit) return ShadingModel::unlit;
    return material.metallic_roughness ? ShadingModel::metallic_roughness : ShadingModel::phong;
}

void set_model(Material& material, ShadingModel model) {
    material.unlit = model == ShadingModel::unlit;
    if (model == ShadingModel::phong) material.metallic_roughness.reset();
    if (model != ShadingModel::metallic_roughness || material.metallic_roughness) return;
    material.metallic_roughness = {.base_color = glm::min(material.diffuse, glm::vec3(1.0F)),
                                   .metallic = 0.0F,
                                   .roughness = roughness_of(material.shininess),
                                   .texture = {}};
}

namespace {

/// The index of a file among the scene's images. Adds the file if it is new.
std::size_t image_of(Scene& scene, const std::filesystem::path& file) {
    const auto is_it = [&](const ImageSource& image) {
        const auto* path = std::get_if<std::filesystem::path>(&image.source);
        return path != nullptr && *path == file;
    };
    const auto found = std::find_if(scene.images.begin(), scene.images.end(), is_it);
    if (found != scene.images.end()) return static_cast<std::size_t>(found - scene.images.begin());
    scene.images.push_back({.name = file.string(), .source = file, .is_required = true});
    return scene.images.size() - 1;
}

}  // namespace

std::string map_title(TextureSlot slot) {
    std::string_view title = slot_info(slot).effect;
    for (const std::string_view kind : {" texture", " map"}) {
        if (title.ends_with(kind)) title.remove_suffix(kind.size());
    }
    return capitalized(fmt::format("{} map", title));
}

bool is_map_used(const Material& material, TextureSlot slot) {
    const TextureSlotInfo& info = slot_info(slot);
    if (slot == TextureSlot::base_color || slot == TextureSlot::opacity) return true;
    if (material.unlit) return false;
    if (slot == TextureSlot::specular) return !material.metallic_roughness;
    if (!is_of_metallic_roughness(info)) return true;
    const bool is_of_extension = slot != TextureSlot::metallic_roughness;
    return material.metallic_roughness &&
           (!is_of_extension || find_texture(material, slot) != nullptr);
}

std::optional<std::string> map_name(const Scene& scene, std::size_t material, TextureSlot slot) {
    const Texture* const texture = find_texture(scene.materials[material], slot);
    if (texture == nullptr) return std::nullopt;
    return scene.images[texture->image].name;
}

namespace {

/// The kinds of maps that a slot accepts. Those of the other slots may be packed in many ways.
std::vector<MapKind> accepted_kinds(TextureSlot slot) {
    switch (slot) {
        case TextureSlot::normal:
            return {MapKind::normal, MapKind::object_normal};
        case TextureSlot::clearcoat_normal:
            return {MapKind::normal};
        case TextureSlot::bump:
            return {MapKind::height};
        case TextureSlot::base_color:
        case TextureSlot::emission:
            return {MapKind::color};
        default:
            return {};
    }
}

}  // namespace

void set_map(Scene& scene, std::size_t material, TextureSlot slot,
             const std::filesystem::path& file) {
    const TextureSlotInfo& slot_of_map = slot_info(slot);
    const ImageInfo info = read_image_info(file);
    const std::string_view used = slot_of_map.channels;
    if (slot_of_map.in_tangent_frame && info.channels < static_cast<int>(used.size())) {
        throw InvalidInput(fmt::format(
            "{}: a{} {} has 3 or 4 channels, not {}; a height map is a \"Bump map\"", file.string(),
            slot == TextureSlot::anisotropy ? "n" : "", slot_of_map.effect, info.channels));
    }
    const std::vector<MapKind> accepted = accepted_kinds(slot);
    if (!accepted.empty()) check_kind(file, accepted, {});
    Material& changed = scene.materials[material];
    const Texture* const before = find_texture(changed, slot);
    Texture texture = before == nullptr ? Texture{} : *before;
    texture.image = image_of(scene, file);
    set_texture(changed, slot, texture);
    if (slot == TextureSlot::bump) changed.normal_map.reset();
    if (slot == TextureSlot::normal) changed.bump_map.reset();
    if (slot != TextureSlot::normal && slot != TextureSlot::clearcoat_normal) return;
    NormalMap* const map = slot == TextureSlot::normal ? &*changed.normal_map
                           : changed.metallic_roughness
                               ? &*changed.metallic_roughness->clearcoat_normal_map
                               : nullptr;
    if (map == nullptr) return;
    map->flat.reset();  // The new image may use another code for zero.
    const MapDescription stated = read_description(info.metadata);
    map->green = stated.green.value_or(map->green);
    if (stated.kind) {
        map->space =
            *stated.kind == MapKind::object_normal ? NormalSpace::object : NormalSpace::tangent;
    }
}

namespace {

/// Edits a color under the title of its field.
template <typename Owner>
bool edit_color(Owner& owner, glm::vec3 Owner::*member, bool has_limit = true) {
    return pick_color(field_of(member).title().c_str(), owner.*member, has_limit);
}

bool edit_metallic_roughness(MetallicRoughness& model) {
    bool changed = edit_color(model, &MetallicRoughness::base_color);
    changed |= slide(model, &MetallicRoughness::metallic);
    changed |= slide(model, &MetallicRoughness::roughness);
    changed |= slide("Refractive index", model.refractive_index, {1.0F, 3.0F});
    changed |= slide(model, &MetallicRoughness::specular);
    changed |= edit_color(model, &MetallicRoughness::specular_color);
    changed |= slide(model, &MetallicRoughness::clearcoat);
    changed |= slide(model, &MetallicRoughness::clearcoat_roughness);
    changed |= edit_color(model, &MetallicRoughness::sheen_color);
    changed |= slide(model, &MetallicRoughness::sheen_roughness);
    changed |= slide(model, &MetallicRoughness::anisotropy);
    changed |= slide_angle("Anisotropy rotation", model.anisotropy_rotation,
                           {-180.0F, 180.0F, "%.0f deg"});
    changed |= slide(model, &MetallicRoughness::iridescence);
    changed |= slide("Film index", model.iridescence_index, {1.0F, 3.0F});
    changed |= slide("Film thickness", model.iridescence_thickness, {0.0F, 1200.0F, "%.0f nm"});
    changed |= slide(model, &MetallicRoughness::transmission);
    changed |= drag_up("Thickness", model.thickness);
    float distance = model.attenuation_distance.value_or(0.0F);
    if (drag_up("Attenuation distance (0: clear)", distance)) {
        model.attenuation_distance = distance > 0.0F ? std::optional(distance) : std::nullopt;
        changed = true;
    }
    changed |= edit_color(model, &MetallicRoughness::attenuation_color);
    return changed;
}

bool edit_phong(Material& material) {
    bool changed = edit_color(material, &Material::diffuse);
    changed |= edit_color(material, &Material::ambient);
    changed |= edit_color(material, &Material::specular);
    changed |= slide("Shininess", material.shininess, {0.0F, 1000.0F, "%.0f", true});
    changed |= choose("Highlights", material.specular_model);
    changed |= check("Fresnel on highlights", material.highlight_fresnel);
    return changed;
}

/// Edits the reflection parameters of the Phong model, which need an environment.
bool edit_reflection(Material& material) {
    bool changed = edit_color(material, &Material::reflectivity);
    changed |= choose("Fresnel", material.fresnel);
    changed |= slide(material, &Material::reflection_roughness);
    changed |= check("Reflection by normal", material.reflection_by_normal);
    changed |= check("Environment tint", material.environment_tint);
    changed |= slide(material, &Material::transmission);
    changed |= slide("Refractive index", material.refractive_index, {1.0F, 3.0F});
    return changed;
}

bool edit_model(Material& material) {
    ShadingModel model = model_of(material);
    bool changed = choose("Model", model);
    if (changed) set_model(material, model);
    if (material.metallic_roughness) {
        changed |= edit_metallic_roughness(*material.metallic_roughness);
    } else if (material.unlit) {
        changed |= pick_color("Color", material.diffuse);
    } else {
        changed |= edit_phong(material);
        changed |= edit_reflection(material);
    }
    if (!material.unlit) {
        changed |= edit_color(material, &Material::emission, false);
    }
    return changed;
}

/// Edits the parameters of a normal map or bump map.
bool edit_relief(Material& material) {
    bool changed = false;
    if (material.normal_map) {
        changed |= slide("Strength", material.normal_map->scale, {0.0F, 4.0F});
        changed |= choose("Green channel", material.normal_map->green);
    }
    if (material.bump_map) {
        changed |= slide("Height", material.bump_map->strength, {0.0F, 128.0F, "%.1f texels"});
    }
    const auto& model = material.metallic_roughness;
    const bool model_has_frame = model && (model->anisotropy > 0.0F || model->clearcoat_normal_map);
    if (material.normal_map || material.bump_map || model_has_frame)
        changed |= choose("Tangents", material.tangent_frame);
    if (material.normal_map || material.bump_map)
        changed |= check("Specular antialiasing", material.specular_antialiasing);
    return changed;
}

/// Returns the small picture of an image, if it has been made.
std::optional<Thumbnail> thumbnail_of(const PanelInput& input, std::size_t image) {
    if (input.thumbnails == nullptr) return std::nullopt;
    input.thumbnails->want();
    const std::optional<Thumbnails::Place> place = input.thumbnails->place_of(image);
    const PictureExchange::Shown& texture = input.thumbnail_texture;
    if (!place || texture.texture == 0) return std::nullopt;
    // The first row of a texture is at the bottom.
    const glm::vec2 scale(1.0F / static_cast<float>(texture.width),
                          1.0F / static_cast<float>(texture.height));
    const glm::vec2 min = glm::vec2(place->min) * scale;
    const glm::vec2 max = glm::vec2(place->min + place->size) * scale;
    return Thumbnail{texture.texture,
                     {min.x, 1.0F - min.y},
                     {max.x, 1.0F - max.y},
                     place->size,
                     place->image_size};
}

/// Edits the files of the maps. If a file cannot be used, the state reports the error.
void edit_maps(const PanelInput& input, std::size_t index) {
    ViewerState& state = input.state;
    for (const TextureSlotInfo& info : texture_slots) {
        const TextureSlot slot = info.slot;
        if (!is_map_used(state.scene().materials[index], slot)) continue;
        const Texture* const texture = find_texture(state.scene().materials[index], slot);
        const FileChoice choice =
            file_field(map_title(slot).c_str(), map_name(state.scene(), index, slot),
                       texture != nullptr ? thumbnail_of(input, texture->image) : std::nullopt);
        if (choice.file) {
            state.try_edit([&](Scene& scene) { set_map(scene, index, slot, *choice.file); });
        } else if (choice.is_cleared) {
            state.edit([&](Scene& scene) { remove_texture(scene.materials[index], slot); });
        }
    }
}

bool edit_surface(Material& material) {
    bool changed = choose("Shading", material.interpolation);
    changed |= choose("Alpha", material.alpha_mode);
    if (material.alpha_mode != AlphaMode::opaque) changed |= slide(material, &Material::opacity);
    if (material.alpha_mode == AlphaMode::mask)
        changed |= slide("Alpha cutoff", material.alpha_cutoff);
    changed |= check("Double-sided", material.double_sided);
    return changed;
}

template <typename Edit>
void edit_part(ViewerState& state, std::size_t index, const Edit& edit) {
    Material material = state.scene().materials[index];
    if (edit(material)) state.edit([&](Scene& scene) { scene.materials[index] = material; });
}

void edit_material(const PanelInput& input, std::size_t index) {
    ViewerState& state = input.state;
    edit_part(state, index, edit_model);
    edit_maps(input, index);
    edit_part(state, index, edit_relief);
    edit_part(state, index, edit_surface);
}

/// Edits properties of all materials at once.
void edit_all(ViewerState& state) {
    const Material& first = state.scene().materials.front();
    Interpolation interpolation = first.interpolation;
    if (choose("Shading of all", interpolation)) {
        state.edit([&](Scene& scene) {
            for (Material& material : scene.materials)
                material.interpolation = interpolation;
        });
    }
    ShadingModel model = model_of(first);
    if (choose("Model of all", model)) {
        state.edit([&](Scene& scene) {
            for (Material& material : scene.materials)
                set_model(material, model);
        });
    }
}

}  // namespace

void draw_material_panel(const PanelInput& input) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    if (uses_default_material(state.scene())) {
        ImGui::TextUnformatted("Default material");
        ImGui::SameLine();
        if (ImGui::SmallButton("Edit")) state.name_default_material();
        probe_item("Edit");
    }
    if (!state.scene().materials.empty()) edit_all(state);
    for (std::size_t i = 0; i < state.scene().materials.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const std::string label = material_label(state.scene(), i);
        if (state.scene().materials.size() == 1) ImGui::SetNextItemOpen(true, ImGuiCond_Once);
        const bool is_open = ImGui::TreeNode("material", "%s", label.c_str());
        probe_item(label);
        if (is_open) {
            edit_material(input, i);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

}  // namespace relief::tools
