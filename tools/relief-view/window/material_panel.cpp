// SPDX-License-Identifier: Apache-2.0
// Materials: the model, its colours and numbers, its maps, how strongly they show.
// Tests: tests/tools/window/panels_test.cpp.
#include <imgui.h>

#include "relief/shade/labels.h"
#include "window/controls.h"
#include "window/file_field.h"
#include "window/map_slots.h"
#include "window/material_models.h"
#include "window/panels.h"
#include "window/places.h"

namespace relief::tools {
namespace {

bool edit_metallic_roughness(MetallicRoughness& model) {
    bool changed = ImGui::ColorEdit3("Base colour", &model.base_color.x);
    changed |= slide("Metallic", model.metallic);
    changed |= slide("Roughness", model.roughness);
    return changed;
}

bool edit_phong(Material& material) {
    bool changed = ImGui::ColorEdit3("Diffuse", &material.diffuse.x);
    changed |= ImGui::ColorEdit3("Ambient share", &material.ambient.x);
    changed |= ImGui::ColorEdit3("Specular", &material.specular.x);
    changed |= slide("Shininess", material.shininess, {0.0F, 1000.0F, "%.0f", true});
    changed |= choose("Highlights", material.specular_model,
                      {"Phong", "Blinn-Phong", "Blinn-Phong, normalised"});
    return changed;
}

/// Of Phong's model; seen only where the scene has surroundings.
bool edit_reflection(Material& material) {
    bool changed = ImGui::ColorEdit3("Reflectivity", &material.reflectivity.x);
    changed |= choose("Fresnel", material.fresnel, {"Schlick", "Dielectric", "Conductor"});
    changed |= slide("Blur", material.reflection_roughness);
    changed |= slide("Transmission", material.transmission);
    changed |= slide("Refraction", material.refractive_index, {1.0F, 3.0F});
    return changed;
}

bool edit_model(Material& material) {
    MaterialModel model = model_of(material);
    bool changed = choose("Model", model, {"Phong", "Metallic-roughness", "Unlit"});
    if (changed) set_model(material, model);
    if (material.metallic_roughness) {
        changed |= edit_metallic_roughness(*material.metallic_roughness);
    } else if (material.unlit) {
        changed |= ImGui::ColorEdit3("Colour", &material.diffuse.x);
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

/// How a normal or bump map shows.
bool edit_relief(Material& material) {
    bool changed = false;
    if (material.normal_map) {
        changed |= slide("Strength", material.normal_map->scale, {0.0F, 4.0F});
        changed |=
            choose("Green is", material.normal_map->green, {"up (OpenGL)", "down (DirectX)"});
    }
    if (material.bump_map) {
        changed |= slide("Height", material.bump_map->strength, {0.0F, 128.0F, "%.1f texels"});
    }
    if (material.normal_map || material.bump_map) {
        changed |= choose("Tangents", material.tangent_frame, {"Stored", "By derivatives"});
        changed |=
            ImGui::Checkbox("Highlights widened by the map", &material.specular_antialiasing);
    }
    return changed;
}

/// Files take their places at once, or say why not.
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
        changed |= slide("Cut off below", material.alpha_cutoff);
    changed |= ImGui::Checkbox("Both sides", &material.double_sided);
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

/// What courses compare first: one choice for every material.
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
        ImGui::TextUnformatted("The default material");
        ImGui::SameLine();
        if (ImGui::SmallButton("Edit it")) state.name_default_material();
        mark_place("Edit it");
    }
    if (!state.scene().materials.empty()) edit_all(state);
    for (std::size_t i = 0; i < state.scene().materials.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const std::string label = material_label(state.scene(), i);
        const bool is_open = ImGui::TreeNode("material", "%s", label.c_str());
        mark_place(label);
        if (is_open) {
            edit_material(state, i);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

}  // namespace relief::tools
