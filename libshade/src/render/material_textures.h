// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which textures a draw samples: the material's, or a neutral one where a forced plan names a
/// texture that the material or the mesh cannot give. Which textures are left out.
/// Tests: tests/shade/render/renderer_test.cpp, forced_effects_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/material.h"
#include "relief/shade/scene.h"
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

/// Takes the textures out of the plan whose images cannot be read, as if the materials did not have
/// them: colors are their factors alone, normals are those of the mesh. A material whose emission
/// texture cannot be read emits nothing, since most texels of such textures are black.
///
/// \param unreadable  by index of the image, what is wrong with it
/// \param report      names each texture: its effect, its material, its image and what is wrong
void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        FramePlan& plan, Report& report);

/// Takes them out of a material of the scene, by the same rules and with the same report.
void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        std::uint32_t number, Material& material, Report& report);

/// Whether the material names any texture at all.
bool has_textures(const Material& material);

}  // namespace relief
