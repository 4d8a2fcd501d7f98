// SPDX-License-Identifier: Apache-2.0
/// \file
/// Formats the names of parts of a scene for messages: the name in quotes, or the index if there is
/// no name.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "relief/shade/scene.h"

namespace relief {

/// Returns "material 'paint'", "material 3" if it has no name, or "the default material" for none.
std::string material_label(const Scene& scene, std::optional<std::size_t> material);

/// Returns "instance 'wheel'"; without a name that of its mesh: "mesh 'Wheel'"; otherwise "instance
/// 3".
std::string instance_label(const Scene& scene, std::size_t instance);

/// Returns "mesh 'Wheel'" or "mesh 3".
std::string mesh_label(const Scene& scene, std::size_t mesh);

}  // namespace relief
