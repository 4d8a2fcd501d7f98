// SPDX-License-Identifier: Apache-2.0
/// \file
/// The default material among those that have a place in the list.
/// Tests: tests/tools/window/material_models_test.cpp.
#pragma once

#include "relief/shade/scene.h"

namespace relief {

/// Gives the default material a place in the list, and every triangle without a material that one:
/// so that it can be edited. Copies the meshes that it changes.
void name_default_material(Scene& scene);

/// Whether some triangle has no material of its own.
bool uses_default_material(const Scene& scene);

}  // namespace relief
