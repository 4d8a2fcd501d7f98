// SPDX-License-Identifier: Apache-2.0
// The one rule for how messages name the parts of a scene. An index that names nothing still makes
// a label. Tests: tests/shade/scene/labels_test.cpp.
#include "relief/shade/labels.h"

#include <fmt/format.h>

namespace relief {

namespace {

/// The name in quotes, or the number.
template <typename Part>
std::string label(const char* kind, const std::vector<Part>& parts, std::size_t index) {
    if (index < parts.size() && !parts[index].name.empty())
        return fmt::format("{} '{}'", kind, parts[index].name);
    return fmt::format("{} {}", kind, index);
}

}  // namespace

std::string material_label(const Scene& scene, std::optional<std::size_t> material) {
    return material ? label("material", scene.materials, *material) : "the default material";
}

std::string instance_label(const Scene& scene, std::size_t instance) {
    if (instance < scene.instances.size() && scene.instances[instance].name.empty()) {
        const std::size_t mesh = scene.instances[instance].mesh;
        if (mesh < scene.meshes.size() && !scene.meshes[mesh].name.empty())
            return mesh_label(scene, mesh);
    }
    return label("instance", scene.instances, instance);
}

std::string mesh_label(const Scene& scene, std::size_t mesh) {
    return label("mesh", scene.meshes, mesh);
}

}  // namespace relief
