// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which textures a draw samples: the material's, or a neutral one where a forced plan names a
/// texture that the material or the mesh cannot give.
/// Tests: tests/shade/render/renderer_test.cpp, forced_effects_test.cpp.
#pragma once

#include <vector>

#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/effects.h"
#include "relief/shade/material.h"
#include "render/program_cache.h"

namespace relief {

/// A sampler of a draw's program.
struct UsedTexture {
    TextureUnit unit{};
    const Texture* texture = nullptr;  ///< None: the neutral texture.
    ImageUse use = ImageUse::color;
};

/// One entry for each of the material's samplers that these features have.
std::vector<UsedTexture> used_textures(const Features& features, const Material& material,
                                       const Mesh& mesh);

/// Whether the material names any texture at all.
bool has_textures(const Material& material);

}  // namespace relief
