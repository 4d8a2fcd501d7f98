// SPDX-License-Identifier: Apache-2.0
/// \file
/// The default material as an entry of the list of materials.
#pragma once

#include "relief/shade/scene.h"

namespace relief {

/// Adds the default material to the list and assigns it to every triangle without a material, so
/// that it can be edited. Copies the meshes that it changes.
void name_default_material(Scene& scene);

/// Tells whether a triangle has no material.
bool uses_default_material(const Scene& scene);

}  // namespace relief
