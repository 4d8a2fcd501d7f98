// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/material_models_test.cpp.
#include "relief/shade/name_materials.h"

#include <algorithm>

#include "relief/shade/effects.h"

namespace relief {
namespace {

bool has_bare_triangles(const Mesh& mesh) {
    if (mesh.triangles.empty()) return false;
    return mesh.material_ranges.empty() ||
           std::any_of(mesh.material_ranges.begin(), mesh.material_ranges.end(),
                       [](const MaterialRange& range) { return !range.material; });
}

}  // namespace

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

}  // namespace relief
