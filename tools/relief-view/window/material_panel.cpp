// SPDX-License-Identifier: Apache-2.0
#include "window/material_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "relief/mesh/image_file.h"
#include "relief/shade/frame_settings.h"
#include "window/controls.h"
#include "window/panels.h"

namespace relief::tools {
namespace {

/// Inverse of shininess = 2
/// alpha^2 - 2, with alpha = roughness^2.
float roughness_of(float shininess) {
    return std::clamp(std::pow(2.0F / (shininess + 2.0F), 0.25F), 0.045F, 1.0F);
}

}  // namespace

MaterialModel model_of(const Material& material) {
    if (material.unlit) return MaterialModel::unlit;
    return material.metallic_roughness ? MaterialModel::metallic_roughness : MaterialModel::phong;
}

void set_model(Material& material, MaterialModel model) {
    material.unlit = model == MaterialModel::unlit;
    if (model == MaterialModel::phong) material.metallic_roughness.reset();
    if (model != MaterialModel::metallic_roughness || material.metallic_roughness) return;
    material.metallic_roughness = {.base_color = glm::min(material.diffuse, glm::vec3(1.0F)),
                                   .metallic = 0.0F,
                                   .roughness = roughness_of(material.shininess),
                                   .texture = {}};
}

namespace {

using MaybeTexture = std::optional<Texture>;

/// Access to a slot that is a member of the material.
template <MaybeTexture Material::*member>
MaybeTexture get(const Material& material) {
    return material.*member;
}
template <MaybeTexture Material::*member>
void put(Material& material, const MaybeTexture& texture) {
    material.*member = texture;
}

bool always(const Material&) {
    return true;
}
bool is_phong(const Material& material) {
    return !material.metallic_roughness && !material.unlit;
}
bool is_metallic(const Material& material) {
    return material.metallic_roughness && !material.unlit;
}
bool is_lit(const Material& material) {
    return !material.unlit;
}

MaybeTexture metallic_texture(const Material& material) {
    return material.metallic_roughness ? material.metallic_roughness->texture : std::nullopt;
}
void set_metallic_texture(Material& material, const MaybeTexture& texture) {
    if (material.metallic_roughness) material.metallic_roughness->texture = texture;
}

MaybeTexture normal_texture(const Material& material) {
    return material.normal_map ? MaybeTexture(material.normal_map->texture) : std::nullopt;
}
void set_normal_texture(Material& material, const MaybeTexture& texture) {
    if (!texture) return material.normal_map.reset();
    if (!material.normal_map) material.normal_map.emplace();
    material.normal_map->texture = *texture;
    material.normal_map->flat.reset();  // The new image may use another code for zero.
    material.bump_map.reset();
}

MaybeTexture bump_texture(const Material& material) {
    return material.bump_map ? MaybeTexture(material.bump_map->texture) : std::nullopt;
}
void set_bump_texture(Material& material, const MaybeTexture& texture) {
    if (!texture) return material.bump_map.reset();
    if (!material.bump_map) material.bump_map.emplace();
    material.bump_map->texture = *texture;
    material.normal_map.reset();
}

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

const std::vector<MapSlot>& map_slots() {
    using M = Material;
    static const std::vector<MapSlot> slots = {
        {"Diffuse map", get<&M::diffuse_texture>, put<&M::diffuse_texture>, always},
        {"Specular map", get<&M::specular_texture>, put<&M::specular_texture>, is_phong},
        {"Metallic and roughness map", metallic_texture, set_metallic_texture, is_metallic},
        {"Normal map", normal_texture, set_normal_texture, is_lit},
        {"Bump map", bump_texture, set_bump_texture, is_lit},
        {"Occlusion map", get<&M::occlusion_texture>, put<&M::occlusion_texture>, is_lit},
        {"Emission map", get<&M::emission_texture>, put<&M::emission_texture>, is_lit},
        {"Opacity map", get<&M::opacity_texture>, put<&M::opacity_texture>, always},
    };
    return slots;
}

std::optional<std::string> map_name(const Scene& scene, std::size_t material, const MapSlot& slot) {
    const MaybeTexture texture = slot.texture(scene.materials[material]);
    if (!texture) return std::nullopt;
    return scene.images[texture->image].name;
}

void set_map(Scene& scene, std::size_t material, const MapSlot& slot,
             const std::filesystem::path& file) {
    read_image_info(file);
    Texture texture = slot.texture(scene.materials[material]).value_or(Texture{});
    texture.image = image_of(scene, file);
    slot.set(scene.materials[material], texture);
}

namespace {

bool edit_metallic_roughness(MetallicRoughness& model) {
    bool changed = ImGui::ColorEdit3("Base color", &model.base_color.x);
    changed |= slide("Metallic", model.metallic);
    changed |= slide("Roughness", model.roughness);
    return changed;
}

bool edit_phong(Material& material) {
    bool changed = ImGui::ColorEdit3("Diffuse", &material.diffuse.x);
    changed |= ImGui::ColorEdit3("Ambient", &material.ambient.x);
    changed |= ImGui::ColorEdit3("Specular", &material.specular.x);
    changed |= slide("Shininess", material.shininess, {0.0F, 1000.0F, "%.0f", true});
    changed |= choose("Highlights", material.specular_model,
                      {"Phong", "Blinn-Phong", "Blinn-Phong, normalized"});
    return changed;
}

/// Edits the reflection parameters of the Phong model, which need an environment.
bool edit_reflection(Material& material) {
    bool changed = ImGui::ColorEdit3("Reflectivity", &material.reflectivity.x);
    changed |= choose("Fresnel", material.fresnel, {"Schlick", "Dielectric", "Conductor"});
    changed |= slide("Reflection roughness", material.reflection_roughness);
    changed |= slide("Transmission", material.transmission);
    changed |= slide("Refractive index", material.refractive_index, {1.0F, 3.0F});
    return changed;
}

bool edit_model(Material& material) {
    MaterialModel model = model_of(material);
    bool changed = choose("Model", model, {"Phong", "Metallic-roughness", "Unlit"});
    if (changed) set_model(material, model);
    if (material.metallic_roughness) {
        changed |= edit_metallic_roughness(*material.metallic_roughness);
    } else if (material.unlit) {
        changed |= ImGui::ColorEdit3("Color", &material.diffuse.x);
    } else {
        changed |= edit_phong(material);
        changed |= edit_reflection(material);
    }
    if (!material.unlit) {
        changed |= ImGui::ColorEdit3("Emission", &material.emission.x,
                                     ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
    }
    return changed;
}

/// Edits the parameters of a normal map or bump map.
bool edit_relief(Material& material) {
    bool changed = false;
    if (material.normal_map) {
        changed |= slide("Strength", material.normal_map->scale, {0.0F, 4.0F});
        changed |=
            choose("Green channel", material.normal_map->green, {"up (OpenGL)", "down (DirectX)"});
    }
    if (material.bump_map) {
        changed |= slide("Height", material.bump_map->strength, {0.0F, 128.0F, "%.1f texels"});
    }
    if (material.normal_map || material.bump_map) {
        changed |= choose("Tangents", material.tangent_frame, {"Stored", "Derivatives"});
        changed |= ImGui::Checkbox("Specular antialiasing", &material.specular_antialiasing);
    }
    return changed;
}

/// Edits the files of the maps. If a file cannot be used, the state reports the error.
void edit_maps(ViewerState& state, std::size_t index) {
    for (const MapSlot& slot : map_slots()) {
        if (!slot.is_used(state.scene().materials[index])) continue;
        const FileChoice choice = file_field(slot.name, map_name(state.scene(), index, slot));
        if (choice.file) {
            state.try_edit([&](Scene& scene) { set_map(scene, index, slot, *choice.file); });
        } else if (choice.is_cleared) {
            state.edit([&](Scene& scene) { slot.set(scene.materials[index], std::nullopt); });
        }
    }
}

bool edit_surface(Material& material) {
    bool changed =
        choose("Shading", material.interpolation, {"Per pixel", "Per vertex (Gouraud)", "Flat"});
    changed |= choose("Alpha", material.alpha_mode, {"Opaque", "Mask", "Blend"});
    if (material.alpha_mode != AlphaMode::opaque) changed |= slide("Opacity", material.opacity);
    if (material.alpha_mode == AlphaMode::mask)
        changed |= slide("Alpha cutoff", material.alpha_cutoff);
    changed |= ImGui::Checkbox("Double-sided", &material.double_sided);
    return changed;
}

template <typename Edit>
void edit_part(ViewerState& state, std::size_t index, const Edit& edit) {
    Material material = state.scene().materials[index];
    if (edit(material)) state.edit([&](Scene& scene) { scene.materials[index] = material; });
}

void edit_material(ViewerState& state, std::size_t index) {
    edit_part(state, index, edit_model);
    edit_maps(state, index);
    edit_part(state, index, edit_relief);
    edit_part(state, index, edit_surface);
}

/// Edits properties of all materials at once.
void edit_all(ViewerState& state) {
    const Material& first = state.scene().materials.front();
    Interpolation interpolation = first.interpolation;
    if (choose("Shading of all", interpolation, {"Per pixel", "Per vertex (Gouraud)", "Flat"})) {
        state.edit([&](Scene& scene) {
            for (Material& material : scene.materials)
                material.interpolation = interpolation;
        });
    }
    MaterialModel model = model_of(first);
    if (choose("Model of all", model, {"Phong", "Metallic-roughness", "Unlit"})) {
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
        const bool is_open = ImGui::TreeNode("material", "%s", label.c_str());
        probe_item(label);
        if (is_open) {
            edit_material(state, i);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

}  // namespace relief::tools
