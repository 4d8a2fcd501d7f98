// SPDX-License-Identifier: Apache-2.0
/// \file
/// The names of parts of a scene in messages: their name in quotes, or their number without a name.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "relief/shade/scene.h"

namespace relief {

/// "material 'paint'", "material 3" if it has no name, "the default material" for none.
std::string material_label(const Scene& scene, std::optional<std::size_t> material);

/// "instance 'wheel'"; without a name that of its mesh: "mesh 'Wheel'"; otherwise "instance 3".
std::string instance_label(const Scene& scene, std::size_t instance);

/// "mesh 'Wheel'" or "mesh 3".
std::string mesh_label(const Scene& scene, std::size_t mesh);

}  // namespace relief
