// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scenes from model files. Tests: tests/shade/scene/scene_file_test.cpp, phong_test.cpp.
#pragma once

#include <filesystem>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"

namespace relief {

/// What load_scene_graph leaves to choice.
struct SceneOptions {
    /// Which model glTF's materials follow.
    enum class MaterialModel {
        as_authored,  ///< Metallic-roughness, which is what they are.
        phong,        ///< Phong's, by phong_from_metallic_roughness with the means of textures.
    };
    MaterialModel model = MaterialModel::as_authored;
};

/// Reads .gltf, .glb, .obj, .ply, .stl, .off or a scene file (.json, docs/scene-files.md) as a
/// scene graph, posed at time 0.
///
/// Meshes without normals get flat ones from glTF (its rule) and angle-weighted ones otherwise.
/// Tangents are left to the effect plan. Lights and the first camera come from glTF; nothing is
/// added where a file has none. Formats without a notion of sides (all but glTF) are double-sided.
/// glTF's light units (lux, candela) become irradiance over pi, so that the picture is the one that
/// KHR_lights_punctual describes.
///
/// A glTF mesh carries the texture coordinates that its material's first texture uses, with that
/// texture's KHR_texture_transform applied. MTL's bump multiplier -bm, which has no unit, counts in
/// BumpMap's default strength: -bm 1 is 16 texels. Beside metallic_roughness a material has its
/// Phong equivalent by the factors alone, for whoever takes metallic_roughness away.
///
/// \param report  counts what is not drawn as its author meant: textures with further texture
///                coordinate sets (left out) or another transform than their material's first;
///                statements of MTL that a material has no place for (map_Ka, map_Ns, disp, refl,
///                scaled or shifted maps); skins and morph targets (drawn at rest), and animations
///                that cannot be played; and, for MaterialModel::phong, unreadable textures whose
///                mean counts as 1
/// \throws FileError as the readers do. An image file that is missing is found missing when it is
///         decoded, and only what is shown is decoded
SceneGraph load_scene_graph(const std::filesystem::path& file, const SceneOptions& options,
                            Report& report);

/// The scene of that graph.
Scene load_scene(const std::filesystem::path& file, const SceneOptions& options, Report& report);

/// The same with the default options.
Scene load_scene(const std::filesystem::path& file, Report& report);

/// What Phong keeps of the textures that it has no place for: their means, colours linear; 1 where
/// there is no texture.
struct TextureMeans {
    glm::vec3 base_color{1.0F};
    float metallic = 1.0F;
    float roughness = 1.0F;
};

/// Metallic-roughness as Phong, textures left out. With the base colour b, metallic m, roughness r
/// and alpha = r^2 as glTF defines them (r at least 0.045, so that alpha^2 is worth a float):
///
///     F0           = mix(0.04, b, m)
///     shininess s  = 2 / alpha^2 - 2
///     specular     = F0 (s + 2) / 8
///     mirror       = t^2 / (t^2 + alpha^2), t = tan 3 degrees
///     reflectivity = F0 * mirror          grazing_reflectivity = mirror
///     diffuse      = b (1 - m)            ambient = diffuse + F0
///
/// - Exponent and factor give the highlight GGX's own peak. Blinn-Phong's facet distribution
///   D = (s + 2) / (2 pi) (n.h)^s is GGX's 1 / (pi alpha^2) at n.h = 1; a microfacet surface shows
///   F D G / (4 n.v) of a light's irradiance, and Phong's term, which has no n.v, stands for G =
///   n.v: F0 (s + 2) / (8 pi) (n.h)^s. The pi is in the light (scene.h). [Blinn 1977],
///   [Walter et al. 2007] (GGX), [Karis 2013] (s from alpha), [Hoffman 2013] (normalisation).
/// - `mirror` is the share of GGX's facets within 3 degrees of the normal (the integral of
///   D (n.h) over that cone). Only they send the eye a picture of the surroundings; the rest blurs
///   it, which this renderer does not show yet. So a rough metal is no mirror.
/// - In ambient light, the same from everywhere, a surface shows what it scatters and what it
///   reflects.
///
/// F0 takes the mean of the base colour's texture into account, diffuse and ambient do not: there
/// the texture itself multiplies.
Material phong_from_metallic_roughness(const GltfMaterial& material, const TextureMeans& means);

/// MTL's own Phong, textures left out: illum 0 is unlit, 1 has no highlight, 3 to 9 reflect by Ks,
/// with Fresnel's effect for 5 and 7 only. Where d is below 1, illum 6 and 7 refract (transmission
/// 1 - d, by Ni); every other model, and map_d, blend, as viewers of OBJ do. Ns above 1e6 counts as
/// 1e6, Ni is kept within [1, 1000]; colours below 0 count as 0.
/// Source: the MTL format's illumination models (Blinn's half vector for all highlights).
Material phong_from_mtl(const MtlMaterial& material);

}  // namespace relief
