// SPDX-License-Identifier: Apache-2.0
/// \file
/// How messages name the parts of a scene: by their name in quotes, and by number where they have
/// none. Tests: tests/shade/scene/labels_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "relief/shade/scene.h"

namespace relief {

/// "material 'paint'", "material 3" if it has no name, "the default material" for none.
std::string material_label(const Scene& scene, std::optional<std::size_t> material);

/// "instance 'wheel'", else by its mesh: "mesh 'Wheel'", else "instance 3".
std::string instance_label(const Scene& scene, std::size_t instance);

/// "mesh 'Wheel'" or "mesh 3".
std::string mesh_label(const Scene& scene, std::size_t mesh);

}  // namespace relief
