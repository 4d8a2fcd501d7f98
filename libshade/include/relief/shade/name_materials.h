// SPDX-License-Identifier: Apache-2.0
/// \file
/// Adds the default material to the list of materials.
#pragma once

#include "relief/shade/scene.h"

namespace relief {

/// Adds the default material to the list and assigns it to every triangle without a material, so
/// that it can be edited. Meshes that change are copied.
void name_default_material(Scene& scene);

/// Returns true if a triangle has no material.
bool uses_default_material(const Scene& scene);

}  // namespace relief
