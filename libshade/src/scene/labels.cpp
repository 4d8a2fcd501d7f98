// SPDX-License-Identifier: Apache-2.0
// The one rule for how messages name the parts of a scene. An index that names nothing still makes
// a label. Tests: tests/shade/scene/labels_test.cpp.
#include "relief/shade/labels.h"

#include <fmt/format.h>

namespace relief {

namespace {

/// The name in quotes, or the number.
std::string label(const char* kind, std::size_t index, const std::string& name) {
    if (!name.empty()) return fmt::format("{} '{}'", kind, name);
    return fmt::format("{} {}", kind, index);
}

/// Empty where there is no such part.
template <typename Named>
std::string name_of(const std::vector<Named>& parts, std::size_t index) {
    return index < parts.size() ? parts[index].name : std::string();
}

std::string name_of(const std::vector<Shared<Mesh>>& meshes, std::size_t index) {
    return index < meshes.size() ? meshes[index]->name : std::string();
}

}  // namespace

std::string material_label(const Scene& scene, std::optional<std::size_t> material) {
    if (!material) return "the default material";
    return label("material", *material, name_of(scene.materials, *material));
}

std::string instance_label(const Scene& scene, std::size_t instance) {
    const std::string name = name_of(scene.instances, instance);
    if (name.empty() && instance < scene.instances.size()) {
        const std::size_t mesh = scene.instances[instance].mesh;
        if (!name_of(scene.meshes, mesh).empty()) return mesh_label(scene, mesh);
    }
    return label("instance", instance, name);
}

std::string mesh_label(const Scene& scene, std::size_t mesh) {
    return label("mesh", mesh, name_of(scene.meshes, mesh));
}

}  // namespace relief
