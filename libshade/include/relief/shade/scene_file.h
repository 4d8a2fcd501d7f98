// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scenes from model files. Tests: tests/shade/scene/scene_file_test.cpp.
#pragma once

#include <filesystem>

#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace relief {

/// Reads .gltf, .glb, .obj, .ply, .stl or .off as a scene.
///
/// Meshes without normals get flat ones from glTF (its rule) and angle-weighted ones otherwise.
/// Tangents are left to the effect plan. Lights and the first camera come from glTF; nothing is
/// added where a file has none.
///
/// \param report  counts what is not drawn as its author meant: blended alpha, texture transforms,
///                further texture coordinate sets, bump maps in MTL, animations at rest
/// \throws FileError as the readers do
Scene load_scene(const std::filesystem::path& file, Report& report);

/// Metallic-roughness as Phong.
///
///     diffuse = base colour * (1 - metallic)     specular = F0 (s + 8) / (8 pi) ... see the source
///     F0 = mix(0.04, base colour, metallic)      shininess s = 2 / roughness^4 - 2
///
/// Metallic and roughness are the factors times the mean of their texture, as Phong has no such
/// maps. \param mean_roughness, mean_metallic  of the texture, 1 where there is none
Material phong_from_metallic_roughness(const GltfMaterial& material, float mean_roughness,
                                       float mean_metallic);

/// MTL's own Phong, with illum 3 and above reflecting by Ks.
Material phong_from_mtl(const MtlMaterial& material);

}  // namespace relief
