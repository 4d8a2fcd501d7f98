// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/material_models_test.cpp.
#include "window/material_models.h"

#include <algorithm>
#include <cmath>

#include "relief/shade/effects.h"

namespace relief::tools {
namespace {

/// s = 2 / alpha^2 - 2 the other way round, with alpha = r^2.
float roughness_of(float shininess) {
    return std::clamp(std::pow(2.0F / (shininess + 2.0F), 0.25F), 0.045F, 1.0F);
}

bool has_bare_triangles(const Mesh& mesh) {
    if (mesh.triangles.empty()) return false;
    return mesh.material_ranges.empty() ||
           std::any_of(mesh.material_ranges.begin(), mesh.material_ranges.end(),
                       [](const MaterialRange& range) { return !range.material; });
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

bool uses_default_material(const Scene& scene) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(),
                       [](const Mesh& mesh) { return has_bare_triangles(mesh); });
}

void name_default_material(Scene& scene) {
    const auto index = static_cast<std::uint32_t>(scene.materials.size());
    bool is_used = false;
    for (Shared<Mesh>& shared : scene.meshes) {
        if (!has_bare_triangles(*shared)) continue;
        is_used = true;
        Mesh& mesh = shared.edit();
        if (mesh.material_ranges.empty()) {
            mesh.material_ranges.push_back(
                {0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt});
        }
        for (MaterialRange& range : mesh.material_ranges) {
            if (!range.material) range.material = index;
        }
    }
    if (is_used) scene.materials.push_back(default_material());
}

}  // namespace relief::tools
