// SPDX-License-Identifier: Apache-2.0
/// \file
/// automatic_distances() for those who have cast the high meshes into a scene already.
#pragma once

#include "bake/ray_scene.h"
#include "relief/mesh/bake.h"

namespace relief {

BakeDistances distances_between(std::span<const Mesh> high, const RayScene& high_scene,
                                const Mesh& low);

}  // namespace relief
