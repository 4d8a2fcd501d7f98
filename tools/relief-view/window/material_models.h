// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which model a material follows, and changing it so that it looks much as before.
/// Tests: tests/tools/window/material_models_test.cpp.
#pragma once

#include "relief/shade/name_materials.h"
#include "relief/shade/scene.h"

namespace relief::tools {

enum class MaterialModel { phong, metallic_roughness, unlit };

MaterialModel model_of(const Material& material);

/// Metallic-roughness from Phong: the diffuse colour as base colour, no metal, and the roughness of
/// which phong_from_metallic_roughness (scene_file.h) makes this shininess. Phong from
/// metallic-roughness: the Phong values that are beside it, which a model file's reader and the
/// step before have left there.
void set_model(Material& material, MaterialModel model);

}  // namespace relief::tools
