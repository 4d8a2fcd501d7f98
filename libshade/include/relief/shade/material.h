// SPDX-License-Identifier: Apache-2.0
/// \file
/// The light of a Material (relief/mesh/material.h) in Phong's model and glTF's metallic-roughness
/// model.
///
/// World space, linear colors. Images are named by their index in Scene::images and decoded only if
/// the effect plan (effects.h) needs them.
///
/// All vectors are in world space and of unit length: n (the normal, perturbed by a
/// normal or bump map), v (to the eye), and for every light i: l (to the light),
/// h = (l + v) / |l + v| and r = 2 (n.l) n - l. L is the light's irradiance at normal incidence
/// over pi, and H that for highlights (lights.h). Products of colors are by channel.
///
/// Phong's model:
///
///     radiance = (1 - F) (1 - transmission) scattered + highlights
///              + F * reflected(2 (n.v) n - v) + (1 - F) transmission * environment(refracted)
///              + emission * emission_texture
///     scattered  = occlusion * tint (ambient * scene.ambient + diffuse * E(n))
///                + tint sum_i L diffuse max(n.l, 0)
///     highlights = specular_texture * N * sum_i H s k [n.l > 0]
///
///     tint = diffuse_texture * vertex color * N
///     N    = with environment_tint the environment in direction n, else 1
///     s    = max(n.h, 0)^shininess (Blinn-Phong), that times (shininess + 2) / 8
///            (blinn_phong_normalized), or max(r.v, 0)^shininess (Phong); x^0 is 1
///     k    = specular, or with highlight_fresnel
///            specular + max(1 - specular, 0) (1 - v.h)^5 [Schlick 1994]
///     E(n) = the environment's irradiance over pi; 0 unless Environment::lights
///     F    = Fresnel's factor at n.v, clamped to [0,1]: by Schlick reflectivity +
///            (grazing_reflectivity - reflectivity) (1 - n.v)^5. If reflectivity is zero or the
///            scene has no environment, F and transmission count as 0
///     reflected(d) = the environment in direction d, blurred by reflection_roughness; with
///            reflection_by_normal, d is n instead
///     refracted = v refracted by refractive_index, once, at the first surface
///     occlusion = 1 + occlusion_strength (occlusion_texture - 1)
///
/// A highlight is the mirror image of its light, so F does not dim it. With Scene::clamp_terms,
/// these terms are clamped to [0,1] by channel before they are multiplied by occlusion, tint and
/// textures, and added: ambient * scene.ambient, diffuse * E(n), emission, and for each light
/// L diffuse max(n.l, 0) and H s k. Here and below, scene.ambient includes that of the lights
/// (ambient_light()).
///
/// glTF's model, with b = base_color * tint, m metallic, roughness r, alpha = r^2, c = b (1 - m),
/// f0 = mix(d, b, m), f90 = mix(specular, 1, m), Schlick's f = f0 + (f90 - f0) (1 - v.h)^5, and D
/// and V GGX's distribution and height-correlated visibility, in which n.v and n.h below 0 count as
/// 0:
///
///     radiance = sum_i L max(n.l, 0) ((1 - f') c + f pi D V)
///              + occlusion (scene.ambient (c + f0) + (1 - f0' A - f90 B) c E(n)
///                           + (f0 A + f90 B) reflected(2 (n.v) n - v))
///              + emission * emission_texture
///
/// Light that facets mirror onto other facets is lost in f pi D V and in A and B. If
/// compensates_energy(), it is added: f pi D V is multiplied by 1 + f0 (1 / (A + B) - 1) [Turquin
/// 2019], and with F = f0 A + f90 B, the mean Fresnel factor a = f0 + (f90 - f0) / 21 and the lost
/// share M = 1 - A - B, the radiance gets occlusion M F a / (1 - M a) reflected(n), blurred by
/// roughness 1 [Fdez-Aguera 2019]. The same share, with f0' for f0, is taken from c E(n).
///
/// d is dielectric_reflectance(). f' and f0' are f and f0 with the largest channel of d, so that a
/// colored reflection does not tint the scattered light. A and B are GGX's directional albedo for
/// f0 and for f90 - f0 at n.v and r (environment_brdf), and the reflected environment is blurred by
/// r; r is at least 0.045.
///
/// With anisotropy s, facets are wider along t, the direction of anisotropy_rotation in the tangent
/// frame, made perpendicular to n: alpha_t = alpha + (1 - alpha) s^2. With b = cross(n, t):
///
///     pi D = 1 / (alpha_t alpha ((t.h / alpha_t)^2 + (b.h / alpha)^2 + max(n.h, 0)^2)^2)
///     V    = 0.5 / (n.l |(alpha_t t.v, alpha b.v, n.v)| + n.v |(alpha_t t.l, alpha b.l, n.l)|)
///
/// The reflected environment is that of the normal mix(v - (b.v) b, n, (1 - s (1 - r))^4). Without
/// a tangent frame, s is 0. The factor of lights has A and B of the isotropic lobe with
///
///     alpha_m^2 = (alpha_t^2 + alpha^2) / 2 - (alpha_t - alpha)^2 / 20
///     n.v_m     = n.v / sqrt((n.v)^2 + ((alpha_t t.v)^2 + (alpha b.v)^2) / alpha_m^2)
///
/// so that a white surface reflects 0.92 to 1.03 of even light, and 0.98 to 1.02 in the mean over
/// all views. n.v_m has the same masking; alpha_m is a fit.
///
/// A thin film replaces f by mix(f, I(v.h), iridescence) and f' by mix(f', max(I(v.h)),
/// iridescence), where I is the reflectance of the film on a base of f0: the light of both surfaces
/// interferes. In the environment's light, f0 A + f90 B and f0' A + f90 B become the same mixtures
/// with I(n.v) (A + B), and f0 in ambient light that with I(1). Where lost light is added, f0 in
/// the factor of lights and a become mixtures with I(n.v), which counts as at most 1. The film lies
/// in air, also under a coat.
///
/// With transmission T, the scattered light is multiplied by 1 - T, and what is behind is added:
///
///     T c (1 - f') behind exp(-length log(1 / attenuation_color) / attenuation_distance)
///
/// f' is at n.v. `behind` is the picture of the skybox and of all surfaces without transmission and
/// blending, over the background, whose color counts as radiance. It is looked up where the
/// refracted ray is after `length`, the thickness times the scale of the object (the cube root of
/// its determinant), seen from the eye; for thickness 0, at the pixel itself. With dispersion, red
/// and blue have rays of their own, refracted by max(n - s, 1) and n + s, with n the refractive
/// index, which is at least 1, and s = (n - 1) dispersion / 40. Rough surfaces look up coarser
/// levels of the picture. The surface itself covers what is behind.
///
/// Sheen adds fibers, and a clear coat covers all of it, emission included. With s the sheen's
/// color, D' and V' Charlie's distribution and visibility for alpha = (sheen_roughness *
/// sheen_roughness_texture)^2 (convolution.h), E their directional albedo at n.v, which counts as
/// at most 1, n' the normal with the coat's map alone, w = clearcoat (0.04 + 0.96 (1 - n'.v)^5),
/// and D, V, A and B of the coat those for clearcoat_roughness and n':
///
///     sheened = (1 - max(s) E) (radiance without emission)
///             + s (sum_i L max(n.l, 0) pi D' V' + E occlusion (scene.ambient + E(n)))
///     coated  = (1 - w) (sheened + emission * emission_texture)
///             + w (sum_i L max(n'.l, 0) pi D V
///                  + occlusion (scene.ambient + (A + B) reflected(2 (n'.v) n' - v)))
///
/// Both roughnesses are at least 0.045. If compensates_energy(), the coat mirrors all light of its
/// weight: its pi D V is divided by A + B, and (1 - A - B) reflected(n'), blurred by roughness 1,
/// is added to its environment.
///
/// alpha = opacity * diffuse_texture.a * vertex color.a * opacity_texture.r. An unlit material
/// shows only diffuse (or base_color) * tint.
///
/// Sources: [Phong 1975], [Blinn 1977], [Blinn 1978], [Schlick 1994], [Walter et al. 2007],
/// [Hoffman 2013], [Karis, SIGGRAPH 2013], [Fdez-Aguera 2019], [Turquin 2019], glTF 2.0, appendix
/// B, with KHR_materials_ior, KHR_materials_specular, KHR_materials_clearcoat, KHR_materials_sheen,
/// KHR_materials_anisotropy, KHR_materials_iridescence, KHR_materials_transmission,
/// KHR_materials_volume and KHR_materials_dispersion, [Estevez and Kulla 2017] and [Belcour and
/// Barla 2017]. The CPU implementation is reference.h.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/material.h"

namespace RELIEF_API relief {
namespace shade {

/// Returns a metallic-roughness material's reflectance at normal incidence for metallic 0:
/// min(((n - 1) / (n + 1))^2 specular_color, 1) specular, with n the refractive index. It is 0.04
/// by default.
glm::vec3 dielectric_reflectance(const MetallicRoughness& model);

/// Returns true if the light that bounces between facets is added to what they mirror. False for a
/// dielectric of roughness 0.05 and less that mirrors up to 4.5% at normal incidence and has
/// neither a coat nor anisotropy: the light adds less than 1% to what it mirrors, at grazing angles
/// only.
bool compensates_energy(const MetallicRoughness& model);

/// Returns the factor of specular_model: 1, or (shininess + 2) / 8.
float specular_normalization(const Material& material);

/// Returns a material of the classic table by name ("gold", "emerald", "red plastic"), with Phong's
/// model and highlights. Its colors were chosen on screens, so they are decoded from sRGB.
/// \return none if the table has no such name
std::optional<Material> material_by_name(std::string_view name);

/// Returns the names of the classic table, sorted.
const std::vector<std::string>& material_names();

}  // namespace shade
}  // namespace relief
