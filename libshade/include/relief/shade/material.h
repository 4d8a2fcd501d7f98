// SPDX-License-Identifier: Apache-2.0
/// \file
/// What surfaces do with light: Phong's model and glTF's metallic-roughness, as plain data.
///
/// World space, linear colours. Images are named by their index in Scene::images and decoded only
/// when the effect plan (effects.h) calls for them. Tests: tests/shade/scene/scene_test.cpp,
/// tests/shade/render/shading_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/normal_map.h"

namespace relief {

/// A use of an image as a texture.
struct Texture {
    std::size_t image = 0;  ///< Index into Scene::images.
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;
};

/// Where light is computed.
enum class Interpolation {
    per_pixel,  ///< At every pixel, from the interpolated normal (Phong shading).
    gouraud,    ///< Lamps at the vertices, interpolated as colours. Phong materials only.
    flat,       ///< At every pixel, from the triangle's own plane.
};

enum class SpecularModel {
    phong,                   ///< (reflect . view)^shininess
    blinn_phong,             ///< (half . normal)^shininess
    blinn_phong_normalized,  ///< The same times (shininess + 2) / 8.
};

/// How much a surface mirrors at an angle.
enum class FresnelModel {
    schlick,     ///< Between reflectivity and grazing_reflectivity; equal ones: no Fresnel effect.
    dielectric,  ///< Exact, unpolarised, from refractive_index; times reflectivity.
    conductor,   ///< Exact, unpolarised, from conductor_index and conductor_absorption; times
                 ///< reflectivity.
};

/// What is there at all.
enum class AlphaMode {
    opaque,  ///< Everywhere, whatever alpha is.
    mask,    ///< Where alpha is at least alpha_cutoff.
    blend,   ///< As much as alpha says, over what is behind; drawn sorted, farthest first.
};

/// Where a tangent-space map's frame comes from.
enum class TangentFrame {
    stored,       ///< The mesh's tangents; MikkTSpace's where it has none.
    derivatives,  ///< From how position and texture coordinates change from pixel to pixel.
};

/// The space of a normal map's vectors.
enum class NormalSpace { tangent, object };

/// A normal map and how to read it (normal_map.h).
struct NormalMap {
    Texture texture;
    float scale = 1.0F;  ///< Multiplies x and y before normalising; of tangent space only.
    Green green = Green::up;
    /// Absent: decided from the image by detect_flat_code.
    std::optional<FlatCode> flat = std::nullopt;
    NormalSpace space = NormalSpace::tangent;
};

/// Heights that bend the normal by finite differences in the shader: central differences over one
/// texel, or over one pixel where that is larger.
struct BumpMap {
    Texture texture;         ///< Red is the height.
    float strength = 16.0F;  ///< The height in texels that the value 1.0 stands for.
};

/// glTF's material. Present in a Material, it takes the place of Phong's ambient, diffuse,
/// specular, shininess and reflectivity; Material::diffuse_texture and vertex colours multiply
/// base_color.
struct MetallicRoughness {
    glm::vec3 base_color{1.0F};
    float metallic = 1.0F;
    float roughness = 1.0F;
    std::optional<Texture> texture;  ///< Green multiplies roughness, blue metallic.
};

/// A material. Everything happens in world space, with unit vectors n (the normal, bent by normal
/// or bump map), v (to the eye), and for every lamp i: l (to it), h = (l + v) / |l + v|,
/// r = 2 (n.l) n - l, L its irradiance at normal incidence over pi, and H the same for highlights
/// (lights.h). Products of colours are by channel.
///
/// Phong's model:
///
///     radiance = (1 - F) (1 - transmission) scattered + highlights
///              + F * surroundings(2 (n.v) n - v) + (1 - F) transmission * environment(refracted)
///              + emission * emission_texture
///     scattered  = occlusion * tint (ambient * scene.ambient + diffuse * E(n))
///                + tint sum_i L diffuse max(n.l, 0)
///     highlights = specular * specular_texture * sum_i H s [n.l > 0]
///
///     tint = diffuse_texture * vertex colour
///     s    = max(n.h, 0)^shininess (Blinn-Phong), that times (shininess + 2) / 8
///            (blinn_phong_normalized), or max(r.v, 0)^shininess (Phong); x^0 is 1
///     E(n) = what the environment sheds on a surface, over pi; 0 unless Environment::lights
///     F    = Fresnel's factor at n.v, kept within [0,1]: by Schlick reflectivity +
///            (grazing_reflectivity - reflectivity) (1 - n.v)^5. 0 where reflectivity is zero or
///            the scene has no environment, and transmission counts as 0 there too
///     surroundings(d) = the environment in direction d, blurred by reflection_roughness
///     refracted = v bent into the surface by refractive_index, once, at the first surface
///     occlusion = 1 + occlusion_strength (occlusion_texture - 1)
///
/// A highlight is the mirror image of its lamp, so F does not dim it.
///
/// glTF's model, with b = base_color * tint, m metallic, roughness r, alpha = r^2,
/// c = b (1 - m), f0 = mix(0.04, b, m), Schlick's f = f0 + (1 - f0) (1 - v.h)^5, and D and V GGX's
/// distribution and height-correlated visibility, in which n.v and n.h below 0 count as 0:
///
///     radiance = sum_i L max(n.l, 0) ((1 - f) c + f pi D V)
///              + occlusion (scene.ambient (c + f0) + (1 - f0 A - B) c E(n)
///                           + (f0 A + B) surroundings(2 (n.v) n - v))
///              + emission * emission_texture
///
/// A and B are GGX's directional albedo for f0 and for 1 - f0 at n.v and r (environment_brdf), and
/// surroundings are blurred by r; r is at least 0.045.
///
/// alpha = opacity * diffuse_texture.a * vertex colour.a * opacity_texture.r. An unlit material
/// shows diffuse (or base_color) * tint and nothing else.
///
/// Sources: [Phong 1975], [Blinn 1977], [Blinn 1978], [Schlick 1994], [Walter et al. 2007],
/// [Hoffman 2013], [Karis, SIGGRAPH 2013], glTF 2.0, appendix B. The CPU twin is reference.h.
struct Material {
    std::string name;
    Interpolation interpolation = Interpolation::per_pixel;
    glm::vec3 ambient{0.8F};  ///< Share of scene.ambient that is scattered.
    glm::vec3 diffuse{0.8F};
    glm::vec3 specular{0.0F};
    glm::vec3 emission{0.0F};
    float shininess = 32.0F;  ///< 0 to 1e6.
    SpecularModel specular_model = SpecularModel::blinn_phong;
    std::optional<MetallicRoughness> metallic_roughness;

    glm::vec3 reflectivity{0.0F};  ///< At normal incidence; zero: no environment reflection at all.
    glm::vec3 grazing_reflectivity{1.0F};  ///< Equal to reflectivity: no Fresnel effect.
    FresnelModel fresnel = FresnelModel::schlick;
    float refractive_index = 1.5F;         ///< Of the inside to the outside, at least 1.
    glm::vec3 conductor_index{0.2F};       ///< Real part of a metal's index, by channel.
    glm::vec3 conductor_absorption{3.0F};  ///< Imaginary part.
    float reflection_roughness = 0.0F;     ///< 0: a mirror. Blurs as GGX of this roughness.
    float transmission = 0.0F;             ///< Share of what is not mirrored that goes through.

    std::optional<Texture> diffuse_texture;    ///< sRGB colour; alpha counts unless opaque.
    std::optional<Texture> specular_texture;   ///< sRGB colour.
    std::optional<Texture> emission_texture;   ///< sRGB colour.
    std::optional<Texture> occlusion_texture;  ///< Red: how much of the surroundings gets here.
    float occlusion_strength = 1.0F;           ///< Within [0,1].
    std::optional<Texture> opacity_texture;    ///< Red.
    std::optional<NormalMap> normal_map;
    std::optional<BumpMap> bump_map;  ///< Not together with a normal map.
    TangentFrame tangent_frame = TangentFrame::stored;
    /// Widens highlights by how much a minified normal map's normals differ within a pixel
    /// [Toksvig 2005].
    bool specular_antialiasing = false;

    AlphaMode alpha_mode = AlphaMode::opaque;
    float opacity = 1.0F;
    float alpha_cutoff = 0.5F;
    bool double_sided = false;  ///< Else back faces are not drawn.
    bool unlit = false;         ///< The diffuse colour as it is, without any light.
};

/// The factor of specular_model, for uniforms and references: 1, or (shininess + 2) / 8.
float specular_normalization(const Material& material);

/// A material of the classic table by name ("gold", "emerald", "red plastic"), as Phong's model
/// with Phong's highlights; its colours, made by eye on screens, are decoded from sRGB. \return
/// nothing if there is none of that name
std::optional<Material> material_by_name(std::string_view name);

/// Every name that material_by_name knows, sorted.
const std::vector<std::string>& material_names();

}  // namespace relief
