// SPDX-License-Identifier: Apache-2.0
/// \file
/// glTF's materials as a scene's. Tests: tests/shade/scene/scene_file_test.cpp.
#pragma once

#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"

namespace relief {

/// The texture coordinates that a material looks its images up at. A mesh of the scene carries one
/// set, so they are those of the material's first texture, in the order base colour, normal,
/// metallic-roughness, occlusion, emission.
struct TexcoordSource {
    int set = 0;
    GltfTextureTransform transform;
};

TexcoordSource texcoord_source(const GltfMaterial& material);

/// The document's materials, in order.
///
/// \param images  the view's; for MaterialModel::phong some of them are decoded, and those that
///                nothing else needs are kept so
/// \param report  counts textures that are left out or drawn elsewhere than their author meant,
///                and, for MaterialModel::phong, images whose mean could not be taken
std::vector<Material> materials_from(const GltfView& view, const SceneOptions& options,
                                     std::vector<ImageSource>& images, Report& report);

}  // namespace relief
