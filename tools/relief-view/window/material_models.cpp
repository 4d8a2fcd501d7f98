// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/material_models_test.cpp.
#include "window/material_models.h"

#include <algorithm>
#include <cmath>

namespace relief::tools {
namespace {

/// s = 2 / alpha^2 - 2 the other way round, with alpha = r^2.
float roughness_of(float shininess) {
    return std::clamp(std::pow(2.0F / (shininess + 2.0F), 0.25F), 0.045F, 1.0F);
}

}  // namespace

MaterialModel model_of(const Material& material) {
    if (material.unlit) return MaterialModel::unlit;
    return material.metallic_roughness ? MaterialModel::metallic_roughness : MaterialModel::phong;
}

void set_model(Material& material, MaterialModel model) {
    material.unlit = model == MaterialModel::unlit;
    if (model == MaterialModel::phong) material.metallic_roughness.reset();
    if (model != MaterialModel::metallic_roughness || material.metallic_roughness) return;
    material.metallic_roughness = {.base_color = glm::min(material.diffuse, glm::vec3(1.0F)),
                                   .metallic = 0.0F,
                                   .roughness = roughness_of(material.shininess),
                                   .texture = {}};
}

}  // namespace relief::tools
