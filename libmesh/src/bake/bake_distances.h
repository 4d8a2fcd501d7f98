// SPDX-License-Identifier: Apache-2.0
/// \file
/// automatic_distances() for callers that already have a scene of the high meshes.
#pragma once

#include "bake/ray_scene.h"
#include "relief/mesh/bake.h"

namespace relief {

BakeDistances distances_between(std::span<const Mesh> high, const RayScene& high_scene,
                                const Mesh& low);

/// The length of a box's diagonal.
double diagonal(const Bounds& box);

/// compare_boxes() of meshes for callers that already have the boxes.
BakeFit compare_boxes(const Bounds& high, const Bounds& low);

}  // namespace relief
