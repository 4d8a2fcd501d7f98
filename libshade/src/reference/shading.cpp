// SPDX-License-Identifier: Apache-2.0
// Material's formula as material.h states it: Phong's model [Phong 1975], [Blinn 1977], and glTF's
// metallic-roughness (glTF 2.0, appendix B; [Walter et al. 2007]). World space, linear light, in
// double; hard cases as in shaders/README.md. Tests: tests/shade/reference/shading_test.cpp.
#include "reference/shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/fresnel.h"
#include "reference/lamps.h"
#include "reference/surface.h"

namespace relief::reference {

namespace {

/// The least roughness of metallic-roughness: smoother, highlights of lamps without size vanish.
constexpr double least_roughness = 0.045;

/// Where a point is shaded, and what its textures hold there.
struct Context {
    const PreparedScene& prepared;
    const Material& material;
    const Surface& surface;
    Trace& trace;

    [[nodiscard]] glm::dvec4 look_up(const std::optional<Texture>& texture, ImageUse use) const {
        if (!texture || !surface.has_texcoord) return glm::dvec4(1.0);
        return prepared.texels.look_up(*texture, use, surface.texcoord, trace);
    }
};

/// 1 at x = 0, whatever the cosine.
double power(double cosine, double exponent) {
    return exponent == 0.0 ? 1.0 : std::pow(std::max(cosine, 0.0), exponent);
}

/// s of the formula.
double highlight(const Material& material, const Surface& at, const glm::dvec3& light) {
    const double shininess = static_cast<double>(material.shininess);
    const glm::dvec3& n = at.normal_world;
    if (material.specular_model == SpecularModel::phong) {
        const glm::dvec3 mirrored = 2.0 * glm::dot(n, light) * n - light;
        return power(glm::dot(mirrored, at.view_world), shininess);
    }
    const glm::dvec3 sum = light + at.view_world;
    const double length = glm::length(sum);
    // Without a half vector it counts as perpendicular to the normal.
    const double cosine = length > 1e-15 ? glm::dot(n, sum) / length : 0.0;
    const double s = power(cosine, shininess);
    const bool normalized = material.specular_model == SpecularModel::blinn_phong_normalized;
    return normalized ? s * (shininess + 2.0) / 8.0 : s;
}

/// What lamps do at one point, before the surface's colours.
struct LampSums {
    glm::dvec3 scattered{0.0};   ///< sum L max(n.l, 0)
    glm::dvec3 highlights{0.0};  ///< sum H s [n.l > 0]
};

LampSums lamp_sums(const Context& context, const Surface& at) {
    LampSums sums;
    for (const Incoming& lamp : incoming_light(context.prepared.scene, at.position_world)) {
        const double n_dot_l = glm::dot(at.normal_world, lamp.light_world);
        context.trace.decide(n_dot_l > 0.0 ? 1 : 0);
        if (!(n_dot_l > 0.0)) continue;
        sums.scattered += lamp.irradiance * n_dot_l;
        sums.highlights +=
            lamp.highlight_irradiance * highlight(context.material, at, lamp.light_world);
    }
    return sums;
}

/// Lamps at the pixel, or at the triangle's corners and interpolated from there.
LampSums interpolated_lamp_sums(const Context& context, const Hit& hit) {
    if (context.material.interpolation != Interpolation::gouraud) {
        return lamp_sums(context, context.surface);
    }
    LampSums sums;
    for (int corner = 0; corner < 3; ++corner) {
        const LampSums there = lamp_sums(context, surface_at_corner(context.prepared, hit, corner));
        sums.scattered += there.scattered * hit.barycentric[corner];
        sums.highlights += there.highlights * hit.barycentric[corner];
    }
    return sums;
}

double occlusion(const Context& context) {
    const double strength = static_cast<double>(context.material.occlusion_strength);
    const double share = context.look_up(context.material.occlusion_texture, ImageUse::data).r;
    return 1.0 + strength * (share - 1.0);
}

/// E(n) of the formula.
glm::dvec3 shed(const Context& context) {
    const auto& described = context.prepared.scene.environment;
    if (!described || !described->lights) return glm::dvec3(0.0);
    return context.prepared.environment->diffuse(context.surface.normal_world);
}

glm::dvec3 surroundings(const Context& context, double roughness) {
    if (!context.prepared.environment) return glm::dvec3(0.0);
    const Surface& at = context.surface;
    const glm::dvec3 mirrored =
        2.0 * glm::dot(at.normal_world, at.view_world) * at.normal_world - at.view_world;
    return context.prepared.environment->blurred(mirrored, roughness, context.trace);
}

/// The environment behind, by Snell's law at the first surface.
glm::dvec3 refracted(const Context& context) {
    if (!context.prepared.environment) return glm::dvec3(0.0);
    const double ratio = 1.0 / static_cast<double>(context.material.refractive_index);
    const glm::dvec3& n = context.surface.normal_world;
    const glm::dvec3& v = context.surface.view_world;
    const double n_dot_v = glm::dot(n, v);
    const double cosine_inside =
        std::sqrt(std::max(1.0 - ratio * ratio * (1.0 - n_dot_v * n_dot_v), 0.0));
    return context.prepared.environment->looked_up(
        -ratio * v + (ratio * n_dot_v - cosine_inside) * n, context.trace);
}

glm::dvec3 emitted(const Context& context) {
    return glm::dvec3(context.material.emission) *
           glm::dvec3(context.look_up(context.material.emission_texture, ImageUse::color));
}

glm::dvec3 phong_radiance(const Context& context, const Hit& hit, const glm::dvec3& tint) {
    const Material& material = context.material;
    const Surface& at = context.surface;
    const glm::dvec3 diffuse(material.diffuse);
    const LampSums lamps = interpolated_lamp_sums(context, hit);
    const glm::dvec3 ambient =
        glm::dvec3(material.ambient) * glm::dvec3(context.prepared.scene.ambient);

    const glm::dvec3 scattered = occlusion(context) * tint * (ambient + diffuse * shed(context)) +
                                 tint * diffuse * lamps.scattered;
    const glm::dvec3 highlights =
        glm::dvec3(material.specular) *
        glm::dvec3(context.look_up(material.specular_texture, ImageUse::color)) * lamps.highlights;
    // Without an environment nothing is mirrored, and nothing seen through the surface.
    glm::dvec3 mirrors(0.0);
    double transmission = 0.0;
    if (context.prepared.environment) {
        mirrors = fresnel_factor(material, glm::dot(at.normal_world, at.view_world));
        transmission = static_cast<double>(material.transmission);
    }
    glm::dvec3 radiance = highlights + emitted(context);
    radiance += (1.0 - mirrors) * (1.0 - transmission) * scattered;
    if (mirrors != glm::dvec3(0.0)) {
        const double roughness = static_cast<double>(material.reflection_roughness);
        radiance += mirrors * surroundings(context, roughness);
    }
    if (transmission > 0.0) radiance += (1.0 - mirrors) * transmission * refracted(context);
    return radiance;
}

/// What metallic-roughness is made of at a point.
struct Microfacets {
    glm::dvec3 scattering;  ///< c
    glm::dvec3 f0;
    double roughness;

    [[nodiscard]] double alpha() const { return roughness * roughness; }
};

Microfacets microfacets_at(const Context& context, const glm::dvec3& tint) {
    const MetallicRoughness& model = *context.material.metallic_roughness;
    const glm::dvec4 texel = context.look_up(model.texture, ImageUse::data);
    const double metallic = static_cast<double>(model.metallic) * texel.b;
    const double roughness = static_cast<double>(model.roughness) * texel.g;
    const glm::dvec3 base = glm::dvec3(model.base_color) * tint;
    return {base * (1.0 - metallic), glm::mix(glm::dvec3(0.04), base, metallic),
            std::max(roughness, least_roughness)};
}

/// pi D V f + (1 - f) c: what one lamp's light becomes. \param n_dot_l  positive
glm::dvec3 scattered_by(const Microfacets& facets, const Surface& at, const glm::dvec3& light,
                        double n_dot_l) {
    const glm::dvec3 sum = light + at.view_world;
    const double length = glm::length(sum);
    // Without a half vector nothing is mirrored.
    if (!(length > 1e-15)) return facets.scattering;
    const glm::dvec3 half = sum / length;
    const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
    const double n_dot_h = std::clamp(glm::dot(at.normal_world, half), 0.0, 1.0);
    const double v_dot_h = std::clamp(glm::dot(at.view_world, half), 0.0, 1.0);
    const double squared = facets.alpha() * facets.alpha();

    const double spread = n_dot_h * n_dot_h * (squared - 1.0) + 1.0;
    const double distribution = squared / (std::numbers::pi * spread * spread);
    const double visibility =
        0.5 / (n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1.0 - squared) + squared) +
               n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1.0 - squared) + squared));
    const glm::dvec3 fresnel = facets.f0 + (1.0 - facets.f0) * std::pow(1.0 - v_dot_h, 5.0);
    return (1.0 - fresnel) * facets.scattering +
           fresnel * (std::numbers::pi * distribution * visibility);
}

/// Light from everywhere: ambient, and what the environment sheds and mirrors.
glm::dvec3 surrounding_light(const Context& context, const Microfacets& facets) {
    const Surface& at = context.surface;
    glm::dvec3 light = glm::dvec3(context.prepared.scene.ambient) * (facets.scattering + facets.f0);
    if (context.prepared.environment) {
        const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
        const glm::dvec2 albedo = directional_albedo(n_dot_v, facets.roughness);
        const glm::dvec3 mirrors = facets.f0 * albedo.x + albedo.y;
        light += (1.0 - mirrors) * facets.scattering * shed(context);
        light += mirrors * surroundings(context, facets.roughness);
    }
    return light;
}

glm::dvec3 metallic_roughness_radiance(const Context& context, const glm::dvec3& tint) {
    const Surface& at = context.surface;
    const Microfacets facets = microfacets_at(context, tint);
    glm::dvec3 radiance =
        occlusion(context) * surrounding_light(context, facets) + emitted(context);
    for (const Incoming& lamp : incoming_light(context.prepared.scene, at.position_world)) {
        const double n_dot_l = glm::dot(at.normal_world, lamp.light_world);
        context.trace.decide(n_dot_l > 0.0 ? 1 : 0);
        if (!(n_dot_l > 0.0)) continue;
        radiance += lamp.irradiance * n_dot_l * scattered_by(facets, at, lamp.light_world, n_dot_l);
    }
    return radiance;
}

}  // namespace

Shaded shade(const PreparedScene& prepared, const Hit& hit, const Material& material,
             Trace& trace) {
    const Surface surface = surface_at(prepared, hit, material, trace);
    const Context context{prepared, material, surface, trace};
    const glm::dvec4 texel = context.look_up(material.diffuse_texture, ImageUse::color);
    const glm::dvec3 tint = glm::dvec3(texel) * glm::dvec3(surface.color);
    const double alpha = static_cast<double>(material.opacity) * texel.a * surface.color.a *
                         context.look_up(material.opacity_texture, ImageUse::data).r;
    if (material.unlit) {
        const glm::vec3 color = material.metallic_roughness
                                    ? material.metallic_roughness->base_color
                                    : material.diffuse;
        return {glm::dvec3(color) * tint, alpha};
    }
    if (material.metallic_roughness) return {metallic_roughness_radiance(context, tint), alpha};
    return {phong_radiance(context, hit, tint), alpha};
}

}  // namespace relief::reference
