// SPDX-License-Identifier: Apache-2.0
// What follows from a material's numbers alone. Tests: tests/shade/scene/scene_test.cpp.
#include "relief/shade/material.h"

namespace relief {

float specular_normalization(const Material& material) {
    const bool normalized = material.specular_model == SpecularModel::blinn_phong_normalized;
    return normalized ? (material.shininess + 2.0F) / 8.0F : 1.0F;
}

}  // namespace relief
