// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scenes from model files. Tests: tests/shade/scene/scene_file_test.cpp, phong_test.cpp.
#pragma once

#include <filesystem>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace relief {

/// Reads .gltf, .glb, .obj, .ply, .stl or .off as a scene.
///
/// Meshes without normals get flat ones from glTF (its rule) and angle-weighted ones otherwise.
/// Tangents are left to the effect plan. Lights and the first camera come from glTF; nothing is
/// added where a file has none. Formats without a notion of sides (all but glTF) are double-sided.
/// glTF's light units (lux, candela) become irradiance over pi, so that the picture is the one that
/// KHR_lights_punctual describes.
///
/// \param report  counts what is not drawn as its author meant: blended or masked alpha, texture
///                transforms, further texture coordinate sets (such a texture is left out), bump
///                maps and transparency in MTL, unreadable metallic-roughness textures (their mean
///                counts as 1)
/// \throws FileError as the readers do. An image file that is missing is found missing when it is
///         decoded, and only what is shown is decoded
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
/// with Fresnel's effect for 5 and 7 only. Ns above 1e6 counts as 1e6; colours below 0 as 0.
/// Source: the MTL format's illumination models (Blinn's half vector for all highlights).
Material phong_from_mtl(const MtlMaterial& material);

}  // namespace relief
