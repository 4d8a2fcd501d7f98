// SPDX-License-Identifier: Apache-2.0
// The panel that edits materials. Tests: tests/tools/window/material_panel_test.cpp.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/map_kind.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/shade/scene_fields.h"
#include "window/controls.h"
#include "window/edit_panels.h"
#include "window/panels.h"

namespace relief::tools {
using namespace relief::shade;

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
    if (slot == TextureSlot::cones) return material.height_map.has_value();
    if (!is_of_metallic_roughness(info)) return true;
    return material.metallic_roughness.has_value();
}

std::optional<std::string> map_name(const Scene& scene, std::size_t material, TextureSlot slot) {
    const Texture* const texture = find_texture(scene.materials[material], slot);
    if (texture == nullptr) return std::nullopt;
    return scene.images[texture->image].name;
}

void set_map(Scene& scene, std::size_t material, TextureSlot slot,
             const std::filesystem::path& file, const AssumedKinds& assumed) {
    const TextureSlotInfo& slot_of_map = slot_info(slot);
    const ImageInfo info = read_image_info(file);
    const std::string_view used = slot_of_map.channels;
    if (slot_of_map.in_tangent_frame && info.channels < static_cast<int>(used.size())) {
        throw InvalidInput(fmt::format(
            "{}: a{} {} has 3 or 4 channels, not {}; a height map is a \"Bump map\"", file.string(),
            slot == TextureSlot::anisotropy ? "n" : "", slot_of_map.effect, info.channels));
    }
    const std::vector<MapKind> accepted = accepted_kinds(slot);
    if (!accepted.empty()) check_kind(file, accepted, assumed);
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

/// Edits the factors of an extension, or those of glTF's core.
bool edit_factors(MetallicRoughness& model, std::string_view extension) {
    bool changed = false;
    for_each_field<MetallicRoughness>([&](const auto& field) {
        if (gltf_extension_of(field.gltf) == extension) changed |= edit_field(model, field);
    });
    return changed;
}

bool edit_highlights(Material& material) {
    bool changed = edit_field(material, &Material::specular);
    changed |= edit_field(material, &Material::shininess);
    changed |= choose("Highlights", material.specular_model);
    changed |= check("Fresnel on highlights", material.highlight_fresnel);
    return changed;
}

/// Edits the reflection parameters of the Phong model, which need an environment.
bool edit_reflection(Material& material) {
    bool changed = edit_field(material, &Material::reflectivity);
    changed |= choose("Fresnel", material.fresnel);
    changed |= edit_field(material, &Material::reflection_roughness);
    changed |= check("Reflection by normal", material.reflection_by_normal);
    changed |= check("Environment tint", material.environment_tint);
    changed |= edit_field(material, &Material::transmission);
    changed |= edit_field(material, &Material::refractive_index);
    return changed;
}

/// Edits the model and its main colors.
bool edit_base(Material& material) {
    ShadingModel model = model_of(material);
    bool changed = choose("Model", model);
    if (changed) set_model(material, model);
    changed |= choose("Shading", material.interpolation);
    changed |= check("Double-sided", material.double_sided);
    if (material.unlit) return pick_color("Color", material.diffuse) || changed;
    if (material.metallic_roughness)
        return edit_factors(*material.metallic_roughness, "") || changed;
    changed |= edit_field(material, &Material::diffuse);
    changed |= edit_field(material, &Material::ambient);
    return changed;
}

/// Edits the parameters of a normal map or bump map.
bool edit_relief(Material& material) {
    bool changed = false;
    if (material.normal_map) {
        changed |= edit_field(*material.normal_map, &NormalMap::scale);
        changed |= choose("Green channel", material.normal_map->green);
    }
    if (material.bump_map) {
        changed |= edit_field(*material.bump_map, &BumpMap::strength);
    }
    if (material.height_map) {
        ReliefMap& map = *material.height_map;
        changed |= choose("Relief method", map.method);
        for_each_field<ReliefMap>([&](const auto& field) { changed |= edit_field(map, field); });
        changed |= check("Relief self-shadow", map.self_shadow);
        changed |= choose("Relief silhouette", map.silhouette);
        changed |= check("Write relief depth", map.write_depth);
    }
    const auto& model = material.metallic_roughness;
    const bool model_has_frame = model && (model->anisotropy > 0.0F || model->clearcoat_normal_map);
    if (material.normal_map || material.bump_map || model_has_frame)
        changed |= choose("Tangents", material.tangent_frame);
    if (material.normal_map || material.bump_map)
        changed |= check("Specular antialiasing", material.specular_antialiasing);
    return changed;
}

bool edit_transparency(Material& material) {
    bool changed = choose("Alpha", material.alpha_mode);
    if (material.alpha_mode != AlphaMode::opaque)
        changed |= edit_field(material, &Material::opacity);
    if (material.alpha_mode == AlphaMode::mask)
        changed |= edit_field(material, &Material::alpha_cutoff);
    return changed;
}

/// Edits the numbers, colors and choices of a group.
bool edit_values(Material& material, const MaterialGroup& group) {
    switch (group.topic) {
        case MaterialTopic::base:
            return edit_base(material);
        case MaterialTopic::highlights:
            return edit_highlights(material);
        case MaterialTopic::reflection:
            return edit_reflection(material);
        case MaterialTopic::relief:
            return edit_relief(material);
        case MaterialTopic::occlusion:
            return material.occlusion_texture &&
                   edit_field(material, &Material::occlusion_strength);
        case MaterialTopic::emission:
            return edit_field(material, &Material::emission);
        case MaterialTopic::transparency:
            return edit_transparency(material);
        case MaterialTopic::extension:
            return edit_factors(*material.metallic_roughness, group.extension);
    }
    return false;
}

/// Returns the small picture of an image, if it has been made.
std::optional<Thumbnail> thumbnail_of(const PanelInput& input, std::size_t image) {
    if (input.thumbnails == nullptr) return std::nullopt;
    input.thumbnails->want();
    const std::optional<Thumbnails::Place> place = input.thumbnails->place_of(image);
    const PictureExchange::Shown& texture = input.thumbnail_texture;
    if (!place || texture.texture == 0) return std::nullopt;
    return thumbnail_in(texture, *place);
}

/// Edits the file of a map. If a file cannot be used, the state reports the error.
void edit_map(const PanelInput& input, std::size_t index, TextureSlot slot,
              PanelRequests& requests) {
    ViewerState& state = input.state;
    const Texture* const texture = find_texture(state.scene().materials[index], slot);
    const std::optional<std::string> name = map_name(state.scene(), index, slot);
    const std::optional<Thumbnail> thumbnail =
        texture != nullptr ? thumbnail_of(input, texture->image) : std::nullopt;
    const FileChoice choice = file_field(map_title(slot).c_str(), name, thumbnail);
    if (choice.is_browsing) {
        requests.browse = BrowseRequest{
            .target = {.kind = BrowseTarget::Kind::map, .material = index, .slot = slot},
            .title = fmt::format("{} of {}", map_title(slot), material_label(state.scene(), index)),
            .folder = folder_to_browse(name, state.options().model),
            .present = name,
            .thumbnail = thumbnail};
    }
    if (choice.file) {
        state.set_map(index, slot, *choice.file);
    } else if (choice.is_cleared) {
        state.edit([&](Scene& scene) { remove_texture(scene.materials[index], slot); });
    }
}

template <typename Edit>
void edit_part(ViewerState& state, std::size_t index, const Edit& edit) {
    Material material = state.scene().materials[index];
    if (edit(material)) state.edit([&](Scene& scene) { scene.materials[index] = material; });
}

void edit_group(const PanelInput& input, std::size_t index, const MaterialGroup& group,
                PanelRequests& requests) {
    edit_part(input.state, index, [&](Material& material) { return edit_values(material, group); });
    for (const TextureSlot slot : group.slots) {
        if (is_map_used(input.state.scene().materials[index], slot))
            edit_map(input, index, slot, requests);
    }
}

/// Draws the header of a group, which starts folded if the group has no effect.
/// \return whether the group is open
bool begins_group(const MaterialGroup& group) {
    ImGui::SetNextItemOpen(group.has_effect, ImGuiCond_Once);
    const bool is_open = ImGui::TreeNode(group.title.c_str());
    probe_item("group " + group.title);
    if (!group.extension.empty() && ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", std::string(group.extension).c_str());
    if (!group.has_effect) {
        ImGui::SameLine();
        ImGui::TextDisabled("no effect");
        probe_item(fmt::format("group {} has no effect", group.title));
    }
    return is_open;
}

void edit_material(const PanelInput& input, std::size_t index, PanelRequests& requests) {
    for (const MaterialGroup& group : material_groups(input.state.scene().materials[index])) {
        if (group.topic == MaterialTopic::base) {
            edit_group(input, index, group, requests);
        } else if (begins_group(group)) {
            // A change of the model, above, ends these groups.
            const Material& material = input.state.scene().materials[index];
            if (group.topic != MaterialTopic::extension || material.metallic_roughness)
                edit_group(input, index, group, requests);
            ImGui::TreePop();
        }
    }
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

void draw_material_panel(const PanelInput& input, PanelRequests& requests) {
    ViewerState& state = input.state;
    if (!state.has_scene()) return;
    if (uses_default_material(state.scene())) {
        ImGui::TextUnformatted("Default material");
        ImGui::SameLine();
        if (ImGui::SmallButton("Edit")) state.name_default_material();
        probe_item("Edit");
    }
    if (!state.scene().materials.empty()) edit_all(state);
    ImGui::PushID(state.options().model.c_str());  // Each model has its own open groups.
    for (std::size_t i = 0; i < state.scene().materials.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const std::string label = material_label(state.scene(), i);
        if (state.scene().materials.size() == 1) ImGui::SetNextItemOpen(true, ImGuiCond_Once);
        const bool is_open = ImGui::TreeNode("material", "%s", label.c_str());
        probe_item(label);
        if (is_open) {
            edit_material(input, i, requests);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
    ImGui::PopID();
}

}  // namespace relief::tools
