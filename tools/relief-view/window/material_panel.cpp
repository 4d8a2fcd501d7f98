// SPDX-License-Identifier: Apache-2.0
// Materials: the model, its colours and numbers, how strongly maps show.
// Tests: tests/tools/window/window_test.cpp.
#include <imgui.h>

#include "relief/shade/labels.h"
#include "window/panels.h"

namespace relief::tools {
namespace {

bool edit_metallic_roughness(MetallicRoughness& model) {
    bool changed = ImGui::ColorEdit3("Base colour", &model.base_color.x);
    changed |= ImGui::SliderFloat("Metallic", &model.metallic, 0.0F, 1.0F);
    changed |= ImGui::SliderFloat("Roughness", &model.roughness, 0.0F, 1.0F);
    return changed;
}

bool edit_phong(Material& material) {
    bool changed = ImGui::ColorEdit3("Diffuse", &material.diffuse.x);
    changed |= ImGui::ColorEdit3("Specular", &material.specular.x);
    changed |= ImGui::SliderFloat("Shininess", &material.shininess, 0.0F, 1000.0F, "%.0f",
                                  ImGuiSliderFlags_Logarithmic);
    int specular = static_cast<int>(material.specular_model);
    if (ImGui::Combo("Highlights", &specular, "Phong\0Blinn-Phong\0Blinn-Phong, normalised\0")) {
        material.specular_model = static_cast<SpecularModel>(specular);
        changed = true;
    }
    changed |= ImGui::ColorEdit3("Reflectivity", &material.reflectivity.x);
    return changed;
}

bool edit_maps(Material& material) {
    bool changed = false;
    if (material.normal_map) {
        changed |= ImGui::SliderFloat("Normal map", &material.normal_map->scale, 0.0F, 4.0F);
        bool down = material.normal_map->green == Green::down;
        if (ImGui::Checkbox("Green is down", &down)) {
            material.normal_map->green = down ? Green::down : Green::up;
            changed = true;
        }
    }
    if (material.bump_map) {
        changed |= ImGui::SliderFloat("Bump strength", &material.bump_map->strength, 0.0F, 128.0F,
                                      "%.1f texels");
    }
    return changed;
}

bool edit(Material& material) {
    bool changed = material.metallic_roughness
                       ? edit_metallic_roughness(*material.metallic_roughness)
                       : edit_phong(material);
    changed |= edit_maps(material);
    int interpolation = static_cast<int>(material.interpolation);
    if (ImGui::Combo("Shading", &interpolation, "Per pixel\0Per vertex (Gouraud)\0Flat\0")) {
        material.interpolation = static_cast<Interpolation>(interpolation);
        changed = true;
    }
    changed |= ImGui::Checkbox("Both sides", &material.double_sided);
    return changed;
}

}  // namespace

void draw_material_panel(const PanelInput& input) {
    if (!input.state.has_scene()) return;
    const Scene& scene = input.state.scene();
    if (scene.materials.empty()) ImGui::TextUnformatted("The default material");
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::TreeNode("material", "%s", material_label(scene, i).c_str())) {
            Material material = scene.materials[i];
            if (edit(material)) {
                input.state.edit([&](Scene& edited) { edited.materials[i] = material; });
                ImGui::TreePop();
                ImGui::PopID();
                return;  // The scene is another one now.
            }
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

}  // namespace relief::tools
