// SPDX-License-Identifier: Apache-2.0
/// \file
/// Counts the uses of the meshes of a document in its scene, with their scales.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <map>

#include "relief/mesh/gltf_document.h"

namespace relief::detail {

/// The instances of a mesh in the scene.
struct MeshInstances {
    std::size_t count = 0;
    double largest = 0.0;  ///< The mean scale of the largest instance.
    double smallest = std::numeric_limits<double>::infinity();
    glm::dmat3 world_from_object{1.0};  ///< Of the largest one, without its translation.
};

/// The instances of each mesh in the default scene. A skinned mesh follows its joints instead of
/// its node.
std::map<std::size_t, MeshInstances> instances_of(const GltfDocument& document);

}  // namespace relief::detail
