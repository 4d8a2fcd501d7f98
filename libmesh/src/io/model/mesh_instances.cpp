// SPDX-License-Identifier: Apache-2.0
// Tests: tests/mesh/io/gltf/model_texcoords_test.cpp, tests/tools/reshaping_test.cpp.
#include "io/model/mesh_instances.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>

namespace relief::detail {
namespace {

/// The transform of a node relative to its parent, without its translation.
glm::dmat3 linear_parent_from_node(const GltfNode& node) {
    if (node.matrix) return glm::dmat3(*node.matrix);
    const glm::dquat rotation(static_cast<double>(node.rotation.w), glm::dvec3(node.rotation));
    return glm::mat3_cast(rotation) * glm::dmat3(glm::dvec3(node.scale.x, 0, 0),
                                                 glm::dvec3(0, node.scale.y, 0),
                                                 glm::dvec3(0, 0, node.scale.z));
}

/// The transform of an instance, without its translation. A skinned mesh follows its joints instead
/// of its node.
glm::dmat3 linear_transform(const GltfView& view, const GltfInstance<GltfPrimitiveId>& instance) {
    const std::optional<std::size_t> skin = view.nodes[instance.node].skin;
    if (!skin || view.skins[*skin].joints.empty()) return glm::dmat3(instance.world_from_object);
    glm::dmat3 result(view.skins[*skin].joint_from_mesh.front());
    for (std::optional<std::size_t> node = view.skins[*skin].joints.front(); node;
         node = view.nodes[*node].parent)
        result = linear_parent_from_node(view.nodes[*node]) * result;
    return result;
}

}  // namespace

std::map<std::size_t, MeshInstances> instances_of(const GltfDocument& document) {
    std::map<std::size_t, MeshInstances> result;
    const GltfView view = document.view();
    std::map<std::size_t, std::size_t> counted_primitive;
    for (const GltfInstance<GltfPrimitiveId>& instance : view.primitives) {
        const GltfPrimitiveId id = instance.what;
        // All primitives of a mesh have the same instances.
        if (counted_primitive.emplace(id.mesh, id.primitive).first->second != id.primitive)
            continue;
        MeshInstances& mesh = result[id.mesh];
        ++mesh.count;
        const glm::dmat3 transform = linear_transform(view, instance);
        const double scale = std::cbrt(std::abs(glm::determinant(transform)));
        if (!std::isfinite(scale) || scale == 0.0) continue;
        mesh.smallest = std::min(mesh.smallest, scale);
        if (scale <= mesh.largest) continue;
        mesh.largest = scale;
        mesh.world_from_object = transform;
    }
    return result;
}

}  // namespace relief::detail
