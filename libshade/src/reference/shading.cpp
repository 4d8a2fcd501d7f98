// SPDX-License-Identifier: Apache-2.0
// Material's formula as material.h states it: Phong's model [Phong 1975], [Blinn 1977], and glTF's
// metallic-roughness (glTF 2.0, appendix B; [Walter et al. 2007]). World space, linear light, in
// double; hard cases as in shaders/README.md. Every term is a TermSum, which a recorder can record.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "portable_math.h"
#include "reference/reference_parts.h"
#include "reference/shading_parts.h"
#include "relief/shade/scene.h"

namespace relief::shade::reference {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

/// The smallest roughness of metallic-roughness. On smoother surfaces, highlights of point lights
/// would vanish.
constexpr double min_roughness = 0.045;

/// Returns the power of a cosine; 1 for the exponent 0, for every cosine.
double power(double cosine, double exponent) {
    return exponent == 0.0 ? 1.0 : portable::pow(std::max(cosine, 0.0), exponent);
}

/// Returns the term s of the formula.
double highlight(const Context& context, const Surface& at, const glm::dvec3& light) {
    const Material& material = context.material;
    const double shininess = static_cast<double>(material.shininess);
    const glm::dvec3& n = at.normal_world;
    if (material.specular_model == SpecularModel::phong) {
        const glm::dvec3 mirrored = 2.0 * glm::dot(n, light) * n - light;
        const double cosine = glm::dot(mirrored, at.view_world);
        context.note("r.v", cosine);
        context.note("shininess", shininess);
        return power(cosine, shininess);
    }
    const glm::dvec3 sum = light + at.view_world;
    const double length = glm::length(sum);
    // An undefined half vector counts as perpendicular to the normal.
    const double cosine = length > 1e-15 ? glm::dot(n, sum) / length : 0.0;
    context.note("n.h", cosine);
    context.note("shininess", shininess);
    const double s = power(cosine, shininess);
    const bool normalized = material.specular_model == SpecularModel::blinn_phong_normalized;
    return normalized ? s * (shininess + 2.0) / 8.0 : s;
}

/// Returns the term k of the formula.
glm::dvec3 highlight_color(const Context& context, const Surface& at, const glm::dvec3& light) {
    const glm::dvec3 specular(context.material.specular);
    if (!context.material.highlight_fresnel) return specular;
    const double cosine = std::clamp(glm::dot(at.view_world, half_vector(light, at)), 0.0, 1.0);
    context.note("ks", specular);
    context.note("v.h", cosine);
    return specular + glm::max(1.0 - specular, 0.0) * portable::pow(1.0 - cosine, 5.0);
}

/// Returns the ambient light of the scene and its lights.
glm::dvec3 ambient_of(const Context& context) {
    const Scene& scene = context.prepared.scene;
    glm::dvec3 sum(scene.ambient);
    const auto add_all = [&](const auto& lights) {
        for (const auto& light : lights) {
            if (light.on) sum += glm::dvec3(light.ambient);
        }
    };
    add_all(scene.directional_lights);
    add_all(scene.point_lights);
    for (const SpotLight& spot : scene.spot_lights) {
        if (spot.point.on) sum += glm::dvec3(spot.point.ambient);
    }
    return sum;
}

/// Returns a term of Phong's model as it is added.
TermSum&& limited(const Context& context, TermSum&& term) {
    if (context.prepared.scene.clamp_terms)
        term.become("clamp", glm::clamp(term.value(), 0.0, 1.0));
    return std::move(term);
}

/// The sums over all lights at one point, before they are multiplied by the surface's textures.
struct LightSums {
    TermSum scattered;   ///< sum L diffuse max(n.l, 0)
    TermSum highlights;  ///< sum H s k [n.l > 0]
};

/// Tells whether the surface faces the light, and the light's radiance is needed.
bool adds_light(const Context& context, double n_dot_l) {
    context.trace.decide(n_dot_l > 0.0 ? 1 : 0);
    return n_dot_l > 0.0 && context.trace.needs_radiance();
}

LightSums light_sums(const Context& context, const Surface& at) {
    LightSums sums;
    for (const Incoming& light : incoming_light(context, at)) {
        const double n_dot_l = glm::dot(at.normal_world, light.light_world);
        if (!adds_light(context, n_dot_l)) continue;
        sums.scattered +=
            limited(context, {context.recorder(), ProbeTermKind::diffuse, light.recorded,
                              named("L", light.irradiance), named("n.l", n_dot_l),
                              named("kd", glm::dvec3(context.material.diffuse))});
        const double s = highlight(context, at, light.light_world);
        const glm::dvec3 k = highlight_color(context, at, light.light_world);
        sums.highlights += limited(
            context, {context.recorder(), ProbeTermKind::highlight, light.recorded,
                      named("H", light.highlight_irradiance), named("s", s), named("k", k)});
    }
    return sums;
}

/// Returns the sums at the pixel, or interpolated from the corners of the triangle.
LightSums interpolated_light_sums(const Context& context, const Hit& hit) {
    if (context.material.interpolation != Interpolation::gouraud) {
        return light_sums(context, context.surface);
    }
    LightSums sums;
    for (int corner = 0; corner < 3; ++corner) {
        const Surface at = surface_at_corner(context.prepared, hit, corner);
        if (Recorder* const recorder = context.recorder())
            recorder->begin_corner(static_cast<std::size_t>(corner), at.normal_world,
                                   at.view_world);
        LightSums there = light_sums(context, at);
        const Named<double> weight = named("weight", hit.barycentric[corner]);
        sums.scattered += there.scattered.multiply(weight);
        sums.highlights += there.highlights.multiply(weight);
    }
    if (Recorder* const recorder = context.recorder()) recorder->end_corners();
    return sums;
}

double occlusion(const Context& context) {
    const double strength = static_cast<double>(context.material.occlusion_strength);
    const double share = context.look_up(TextureSlot::occlusion).r;
    return (1.0 + strength * (share - 1.0)) * context.surface.open_share;
}

/// Returns the term E(n) of the formula.
glm::dvec3 environment_irradiance(const Context& context) {
    const auto& described = context.prepared.scene.environment;
    if (!described || !described->lights) return glm::dvec3(0.0);
    return context.prepared.environment->diffuse(context.surface.normal_world);
}

/// Returns the environment along the normal.
glm::dvec3 along_normal(const Context& context, double roughness) {
    return context.prepared.environment->blurred(context.surface.normal_world, roughness,
                                                 context.trace);
}

/// Returns the environment that a surface with this normal reflects.
glm::dvec3 reflected(const Context& context, const glm::dvec3& normal, double roughness) {
    if (!context.prepared.environment) return glm::dvec3(0.0);
    const glm::dvec3& view = context.surface.view_world;
    const glm::dvec3 mirrored = 2.0 * glm::dot(normal, view) * normal - view;
    context.note("d", mirrored);
    context.note("roughness", roughness);
    return context.prepared.environment->blurred(mirrored, roughness, context.trace);
}

/// Returns the refracted environment, by Snell's law at the first surface.
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

glm::dvec3 emission_texel(const Context& context) {
    return glm::dvec3(context.look_up(TextureSlot::emission));
}

/// Returns a sum with one term.
template <typename... Values>
TermSum term(const Context& context, ProbeTermKind kind, const Named<Values>&... factors) {
    return {context.recorder(), kind, no_light, factors...};
}

/// Returns the emission of metallic-roughness.
TermSum emitted(const Context& context) {
    return term(context, ProbeTermKind::emission,
                named("ke", glm::dvec3(context.material.emission)),
                named("texel", emission_texel(context)));
}

/// Returns the term N of the formula.
glm::dvec3 environment_tint(const Context& context) {
    const bool has_tint = context.material.environment_tint && context.prepared.environment;
    return has_tint ? along_normal(context, 0.0) : glm::dvec3(1.0);
}

TermSum phong_radiance(const Context& context, const Hit& hit, const glm::dvec3& tint) {
    const Material& material = context.material;
    const Surface& at = context.surface;
    LightSums lights = interpolated_light_sums(context, hit);
    const Named<glm::dvec3> around = named("N", environment_tint(context));

    TermSum scattered = limited(
        context, term(context, ProbeTermKind::ambient, named("ka", glm::dvec3(material.ambient)),
                      named("La", ambient_of(context))));
    scattered += limited(context, term(context, ProbeTermKind::environment_light,
                                       named("kd", glm::dvec3(material.diffuse)),
                                       named("E(n)", environment_irradiance(context))));
    scattered.multiply(named("occlusion", occlusion(context)));
    scattered += std::move(lights.scattered);
    scattered.multiply(around, named("tint", tint));
    TermSum highlights = std::move(lights.highlights);
    highlights.multiply(
        around, named("specular texel", glm::dvec3(context.look_up(TextureSlot::specular))));
    // Without an environment there are neither reflections nor transmitted light.
    glm::dvec3 mirrors(0.0);
    double transmission = 0.0;
    if (context.prepared.environment) {
        mirrors = fresnel_factor(material, glm::dot(at.normal_world, at.view_world));
        transmission = static_cast<double>(material.transmission);
    }
    const Named<glm::dvec3> kept = named("1 - F", 1.0 - mirrors);
    TermSum radiance = std::move(highlights);
    TermSum emission = limited(context, term(context, ProbeTermKind::emission,
                                             named("ke", glm::dvec3(material.emission))));
    radiance += emission.multiply(named("texel", emission_texel(context)));
    radiance += scattered.multiply(kept, named("1 - T", 1.0 - transmission));
    if (mirrors != glm::dvec3(0.0)) {
        const double roughness = static_cast<double>(material.reflection_roughness);
        context.note("n.v", glm::dot(at.normal_world, at.view_world));
        const glm::dvec3 seen = material.reflection_by_normal
                                    ? along_normal(context, roughness)
                                    : reflected(context, at.normal_world, roughness);
        radiance += term(context, ProbeTermKind::reflection, named("F", mirrors), named("R", seen));
    }
    if (transmission > 0.0) {
        radiance += term(context, ProbeTermKind::refraction, kept, named("T", transmission),
                         named("refracted", refracted(context)));
    }
    return radiance;
}

/// The directions of anisotropic facets.
struct Anisotropy {
    glm::dvec3 rough_axis{0.0};   ///< t: unit, perpendicular to the normal.
    glm::dvec3 smooth_axis{0.0};  ///< b = cross(n, t)
    double strength = 0.0;        ///< 0 without a tangent frame.
};

Anisotropy anisotropy_at(const Context& context) {
    const MetallicRoughness& model = *context.material.metallic_roughness;
    const Surface& at = context.surface;
    const double rotation = static_cast<double>(model.anisotropy_rotation);
    glm::dvec2 direction(1.0, 0.0);  // Before the rotation.
    double strength = static_cast<double>(model.anisotropy);
    if (model.anisotropy_texture && at.has_texcoord) {
        const glm::dvec4 texel = context.prepared.texels.look_up(
            *model.anisotropy_texture, ImageUse::data, at.texcoord, context.trace);
        const glm::dvec2 stored = 2.0 * glm::dvec2(texel) - 1.0;
        if (glm::length(stored) > 1e-15) direction = glm::normalize(stored);
        strength *= texel.b;
    }
    const double cosine = portable::cos(rotation);
    const double sine = portable::sin(rotation);
    const glm::dvec3 along = (cosine * direction.x - sine * direction.y) * at.tangent_world +
                             (sine * direction.x + cosine * direction.y) * at.bitangent_world;
    const glm::dvec3 in_surface = along - glm::dot(at.normal_world, along) * at.normal_world;
    const double length = glm::length(in_surface);
    if (!(length > 1e-15)) return {};
    const glm::dvec3 axis = in_surface / length;
    return {axis, glm::cross(at.normal_world, axis), strength};
}

/// The quantities of metallic-roughness at a point.
struct Microfacets {
    glm::dvec3 scattering;  ///< c (1 - T)
    glm::dvec3 passing;     ///< c T
    glm::dvec3 f0;
    glm::dvec3 blocking_f0;  ///< f0'
    double f90;
    double roughness;
    Anisotropy anisotropy;
    double film;            ///< The weight of the thin film.
    double film_thickness;  ///< In nanometers.
};

Microfacets microfacets_at(const Context& context, const glm::dvec3& tint) {
    const MetallicRoughness& model = *context.material.metallic_roughness;
    const glm::dvec4 texel = context.look_up(TextureSlot::metallic_roughness);
    const double metallic = static_cast<double>(model.metallic) * texel.b;
    const double roughness = static_cast<double>(model.roughness) * texel.g;
    const glm::dvec3 base = glm::dvec3(model.base_color) * tint;
    const double specular =
        static_cast<double>(model.specular) * context.look_up(TextureSlot::specular_weight).a;
    const glm::dvec3 color =
        glm::dvec3(model.specular_color) * glm::dvec3(context.look_up(TextureSlot::specular_color));
    const double index = static_cast<double>(model.refractive_index);
    const glm::dvec3 dielectric = specular * glm::min(fresnel(index, 1.0) * color, 1.0);
    const double film =
        static_cast<double>(model.iridescence) * context.look_up(TextureSlot::iridescence).r;
    const double thickness = glm::mix(static_cast<double>(model.iridescence_thickness_minimum),
                                      static_cast<double>(model.iridescence_thickness),
                                      context.look_up(TextureSlot::iridescence_thickness).g);
    const double largest = std::max({dielectric.r, dielectric.g, dielectric.b});
    const double transmission =
        static_cast<double>(model.transmission) * context.look_up(TextureSlot::transmission).r;
    return {base * ((1.0 - metallic) * (1.0 - transmission)),
            base * ((1.0 - metallic) * transmission),
            glm::mix(dielectric, base, metallic),
            glm::mix(glm::dvec3(largest), base, metallic),
            glm::mix(specular, 1.0, metallic),
            std::max(roughness, min_roughness),
            anisotropy_at(context),
            film,
            thickness};
}

/// Returns pi D V of GGX about a normal. \param n_dot_l  positive
double ggx_lobe(const Context& context, const glm::dvec3& normal, const glm::dvec3& half,
                const Surface& at, double n_dot_l, double roughness) {
    const double alpha = roughness * roughness;
    const double squared = alpha * alpha;
    const double n_dot_v = std::clamp(glm::dot(normal, at.view_world), 0.0, 1.0);
    const double n_dot_h = std::clamp(glm::dot(normal, half), 0.0, 1.0);
    const double spread = n_dot_h * n_dot_h * (squared - 1.0) + 1.0;
    const double distribution = squared / (std::numbers::pi * spread * spread);
    const double visibility =
        0.5 / (n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1.0 - squared) + squared) +
               n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1.0 - squared) + squared));
    context.note("n.v", n_dot_v);
    context.note("n.h", n_dot_h);
    context.note("alpha", alpha);
    context.note("D", distribution);
    context.note("V", visibility);
    return std::numbers::pi * distribution * visibility;
}

/// Records the phase of the film, which jumps where film and base have the same index.
void decide_phase(const Context& context, const Microfacets& facets) {
    if (facets.film == 0.0) return;
    const double index =
        static_cast<double>(context.material.metallic_roughness->iridescence_index);
    for (int i = 0; i < 3; ++i) {
        const double root = std::sqrt(std::min(facets.f0[i], 0.9999));
        context.trace.decide((1.0 + root) / (1.0 - root) < index ? 1 : 0);
    }
}

/// The light that facets mirror, and the light that scattering therefore lacks.
struct Mirrored {
    glm::dvec3 mirrored;
    glm::dvec3 blocked;
};

/// Returns both with the material's film.
/// \param share  of a surface that mirrors all light
Mirrored with_film(const Context& context, const Microfacets& facets, double cosine, double share,
                   const Mirrored& plain) {
    if (facets.film == 0.0 || !context.trace.needs_radiance()) return plain;
    const double index =
        static_cast<double>(context.material.metallic_roughness->iridescence_index);
    const glm::dvec3 film = film_reflectance(facets.f0, cosine, index, facets.film_thickness);
    const double largest = std::min(std::max({film.r, film.g, film.b}), 1.0);
    return {glm::mix(plain.mirrored, share * film, facets.film),
            glm::mix(plain.blocked, glm::dvec3(share * largest), facets.film)};
}

/// Returns the mean of Schlick's factor over the hemisphere.
glm::dvec3 mean_schlick(const glm::dvec3& f0, double f90) {
    return f0 + (glm::dvec3(f90) - f0) / 21.0;
}

/// Returns what facets mirror after the first bounce, and what scattering lacks of it:
/// [Fdez-Aguera 2019], equations 13 to 18. No directions are left, so these are shares of the light
/// about the normal.
///
/// \param albedo  A and B  \param once  the shares of the first bounce
Mirrored bounced(const Context& context, const Microfacets& facets, double n_dot_v,
                 const glm::dvec2& albedo, const Mirrored& once) {
    if (!compensates_energy(*context.material.metallic_roughness))
        return {glm::dvec3(0.0), glm::dvec3(0.0)};
    const auto mean = with_film(
        context, facets, n_dot_v, 1.0,
        {mean_schlick(facets.f0, facets.f90), mean_schlick(facets.blocking_f0, facets.f90)});
    const double lost = 1.0 - albedo.x - albedo.y;
    const auto share = [&](const glm::dvec3& first, const glm::dvec3& fresnel) {
        const glm::dvec3 limited = glm::min(fresnel, 1.0);
        return first * limited * lost / (1.0 - lost * limited);
    };
    return {share(once.mirrored, mean.mirrored), share(once.blocked, mean.blocked)};
}

/// Returns directional_albedo(), or if the radiance is not needed, that of a mirror.
glm::dvec2 albedo_of(const Context& context, double n_dot_v, double roughness) {
    return context.trace.needs_radiance() ? directional_albedo(n_dot_v, roughness)
                                          : glm::dvec2(1.0, 0.0);
}

/// Returns A and B of the material's lobe. A lobe that is wider along one axis has those of the
/// isotropic lobe with the mean width, from the angle at which as many facets are masked.
glm::dvec2 lobe_albedo(const Context& context, const Microfacets& facets, double n_dot_v) {
    const Surface& at = context.surface;
    const Anisotropy& a = facets.anisotropy;
    if (a.strength == 0.0) return albedo_of(context, n_dot_v, facets.roughness);
    const double alpha = facets.roughness * facets.roughness;
    const double along = glm::mix(alpha, 1.0, a.strength * a.strength);
    const double width_squared =
        0.5 * (along * along + alpha * alpha) - 0.05 * (along - alpha) * (along - alpha);
    const double t_part = along * glm::dot(a.rough_axis, at.view_world);
    const double t_dot_v = glm::dot(a.rough_axis, at.view_world);
    const double b_squared = std::max(1.0 - n_dot_v * n_dot_v - t_dot_v * t_dot_v, 0.0);
    const double stretched = (t_part * t_part + alpha * alpha * b_squared) / width_squared;
    return albedo_of(context, n_dot_v / std::sqrt(n_dot_v * n_dot_v + stretched),
                     std::sqrt(std::sqrt(width_squared)));
}

/// Returns the factor of highlights that adds the light of further bounces [Turquin 2019].
glm::dvec3 highlight_gain(const Context& context, const Microfacets& facets) {
    if (!compensates_energy(*context.material.metallic_roughness)) return glm::dvec3(1.0);
    const Surface& at = context.surface;
    const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
    const glm::dvec2 albedo = lobe_albedo(context, facets, n_dot_v);
    const glm::dvec3 f0 =
        glm::min(with_film(context, facets, n_dot_v, 1.0, {facets.f0, facets.f0}).mirrored, 1.0);
    return 1.0 + f0 * (1.0 / (albedo.x + albedo.y) - 1.0);
}

/// Returns pi D V of the material's facets, which may be wider along one axis than along the other.
/// \param n_dot_l  positive
double facet_lobe(const Context& context, const Microfacets& facets, const glm::dvec3& light,
                  const glm::dvec3& half, double n_dot_l) {
    const Surface& at = context.surface;
    const Anisotropy& a = facets.anisotropy;
    if (a.strength == 0.0)
        return ggx_lobe(context, at.normal_world, half, at, n_dot_l, facets.roughness);
    const double alpha = facets.roughness * facets.roughness;
    const double along = glm::mix(alpha, 1.0, a.strength * a.strength);
    const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
    const double n_dot_h = glm::dot(at.normal_world, half);
    const double b_dot_h = glm::dot(a.smooth_axis, half) / alpha;
    // If n.h counts as 0, t.h and b.h alone have the squared length 1.
    const double t_dot_h =
        n_dot_h > 0.0
            ? glm::dot(a.rough_axis, half) / along
            : std::sqrt(1.0 - glm::dot(a.smooth_axis, half) * glm::dot(a.smooth_axis, half)) /
                  along;
    const double n_part = std::max(n_dot_h, 0.0);
    const double spread = t_dot_h * t_dot_h + b_dot_h * b_dot_h + n_part * n_part;
    const double distribution = 1.0 / (along * alpha * spread * spread);
    const auto stretched = [&](const glm::dvec3& direction, double cosine) {
        return glm::length(glm::dvec3(along * glm::dot(a.rough_axis, direction),
                                      alpha * glm::dot(a.smooth_axis, direction), cosine));
    };
    const double masked =
        n_dot_l * stretched(at.view_world, n_dot_v) + n_dot_v * stretched(light, n_dot_l);
    context.note("n.v", n_dot_v);
    context.note("n.h", n_dot_h);
    context.note("alpha", alpha);
    context.note("alpha_t", along);
    context.note("D", distribution / std::numbers::pi);
    context.note("V", 0.5 / masked);
    return distribution * 0.5 / masked;
}

/// Returns pi D V f gain + (1 - f') c, the factor of one light.
/// \param n_dot_l  positive  \param gain  highlight_gain()
TermSum scattered_by(const Context& context, const Microfacets& facets, const Incoming& light,
                     double n_dot_l, const glm::dvec3& gain) {
    const Surface& at = context.surface;
    const auto begin = [&](ProbeTermKind kind, const auto&... factors) {
        return TermSum(context.recorder(), kind, light.recorded, factors...);
    };
    const glm::dvec3 half = half_vector(light.light_world, at);
    if (half == glm::dvec3(0.0))
        return begin(ProbeTermKind::diffuse, named("c", facets.scattering));
    const double v_dot_h = std::clamp(glm::dot(at.view_world, half), 0.0, 1.0);
    const double grazing = portable::pow(1.0 - v_dot_h, 5.0);
    const auto [mirrored, blocked] =
        with_film(context, facets, v_dot_h, 1.0,
                  {glm::mix(facets.f0, glm::dvec3(facets.f90), grazing),
                   glm::mix(facets.blocking_f0, glm::dvec3(facets.f90), grazing)});
    TermSum sum = begin(ProbeTermKind::diffuse, named("1 - f'", 1.0 - blocked),
                        named("c", facets.scattering));
    context.note("v.h", v_dot_h);
    context.note("f0", facets.f0);
    const double lobe = facet_lobe(context, facets, light.light_world, half, n_dot_l);
    sum += begin(ProbeTermKind::highlight, named("f", mirrored), named("gain", gain),
                 named("pi D V", lobe));
    return sum;
}

/// Returns the normal that mirrors the environment.
glm::dvec3 mirror_normal(const Microfacets& facets, const Surface& at) {
    const Anisotropy& a = facets.anisotropy;
    const glm::dvec3 leaning =
        at.view_world - glm::dot(a.smooth_axis, at.view_world) * a.smooth_axis;
    const double kept = portable::pow(1.0 - a.strength * (1.0 - facets.roughness), 4.0);
    const glm::dvec3 normal = glm::mix(leaning, at.normal_world, kept);
    const double length = glm::length(normal);
    return length > 1e-15 ? normal / length : at.normal_world;
}

/// Returns the light from all directions: ambient light, and the scattered and reflected
/// environment.
TermSum indirect_light(const Context& context, const Microfacets& facets) {
    const Surface& at = context.surface;
    const Mirrored facing = with_film(context, facets, 1.0, 1.0, {facets.f0, facets.f0});
    TermSum light = term(context, ProbeTermKind::ambient, named("La", ambient_of(context)),
                         named("c + f0", facets.scattering + facing.mirrored));
    if (context.prepared.environment) {
        const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
        const glm::dvec2 albedo = albedo_of(context, n_dot_v, facets.roughness);
        const Mirrored once = with_film(context, facets, n_dot_v, albedo.x + albedo.y,
                                        {facets.f0 * albedo.x + facets.f90 * albedo.y,
                                         facets.blocking_f0 * albedo.x + facets.f90 * albedo.y});
        const Mirrored later = bounced(context, facets, n_dot_v, albedo, once);
        light +=
            term(context, ProbeTermKind::environment_light,
                 named("unmirrored", 1.0 - once.blocked - later.blocked),
                 named("c", facets.scattering), named("E(n)", environment_irradiance(context)));
        context.note("n.v", n_dot_v);
        context.note("f0", facets.f0);
        context.note("A", albedo.x);
        context.note("B", albedo.y);
        const glm::dvec3 seen = reflected(context, mirror_normal(facets, at), facets.roughness);
        light += term(context, ProbeTermKind::reflection, named("f0 A + f90 B", once.mirrored),
                      named("R", seen));
        if (later.mirrored != glm::dvec3(0.0)) {
            light += term(context, ProbeTermKind::interreflection, named("bounced", later.mirrored),
                          named("R", along_normal(context, 1.0)));
        }
    }
    return light;
}

/// Returns the index of the volume for red, green and blue: by the Abbe number V = 20 / dispersion
/// the indices of blue and red differ by (n - 1) / V, half of it on either side of green.
glm::dvec3 volume_indices(const MetallicRoughness& model) {
    const double index = static_cast<double>(model.refractive_index);
    const double half =
        0.5 * std::max(index - 1.0, 0.0) * static_cast<double>(model.dispersion) / 20.0;
    return {std::max(index - half, std::min(index, 1.0)), index, index + half};
}

/// Returns the light from behind the surface.
TermSum passing_light(const Context& context, const Microfacets& facets, const Hit& hit) {
    const Surface& at = context.surface;
    if (!is_transmissive(context.material, *context.prepared.instances[hit.instance].mesh))
        return {};
    const MetallicRoughness& model = *context.material.metallic_roughness;
    const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
    const glm::dvec3 blocked =
        with_film(context, facets, n_dot_v, 1.0,
                  {facets.f0, glm::mix(facets.blocking_f0, glm::dvec3(facets.f90),
                                       portable::pow(1.0 - n_dot_v, 5.0))})
            .blocked;
    const glm::dmat3 world_from_object(
        context.prepared.scene.instances[hit.instance].world_from_object);
    const double scale = portable::pow(std::abs(glm::determinant(world_from_object)), 1.0 / 3.0);
    const double length =
        static_cast<double>(model.thickness) * scale * context.look_up(TextureSlot::thickness).g;
    const glm::dvec3 indices = volume_indices(model);
    const double index = indices.g;
    const double spread = index > 0.0 ? std::clamp(2.0 * index - 2.0, 0.0, 1.0) : 1.0;
    const double blur = spread * (facets.roughness - min_roughness) / (1.0 - min_roughness);
    const auto seen = [&](double by_index) {
        const double ratio = by_index > 0.0 ? 1.0 / by_index : 0.0;
        const glm::dvec3 path = length * glm::refract(-at.view_world, at.normal_world, ratio);
        return context.prepared.behind->look_up(at.position_world + path, at.position_world, blur,
                                                context.trace);
    };
    glm::dvec3 light = seen(index);
    if (indices.r != indices.b) {
        light.r = seen(indices.r).r;
        light.b = seen(indices.b).b;
    }
    context.note("length", length);
    context.note("blur", blur);
    if (model.attenuation_distance) {
        context.note("unattenuated", light);
        const double lengths = length / static_cast<double>(*model.attenuation_distance);
        const glm::dvec3 color = glm::max(glm::dvec3(model.attenuation_color), 1e-6);
        for (int i = 0; i < 3; ++i)
            light[i] *= portable::pow(color[i], lengths);
    }
    return term(context, ProbeTermKind::transmission, named("c T", facets.passing),
                named("1 - f'", 1.0 - blocked), named("behind", light));
}

/// Returns the sums of light that a layer receives about a normal: sum_i L lobe(n.l, h).
/// \param symbol  of the lobe
template <typename Lobe>
TermSum received(const Context& context, const glm::dvec3& normal, ProbeTermKind kind,
                 const char* symbol, Lobe lobe) {
    const Surface& at = context.surface;
    TermSum sum;
    for (const Incoming& light : incoming_light(context, at)) {
        const double n_dot_l = glm::dot(normal, light.light_world);
        if (!adds_light(context, n_dot_l)) continue;
        const glm::dvec3 half = half_vector(light.light_world, at);
        if (half == glm::dvec3(0.0)) continue;
        context.note("n.l", n_dot_l);
        const double share = lobe(n_dot_l, half);
        sum += {context.recorder(), kind, light.recorded, named("L", light.irradiance),
                named(symbol, share)};
    }
    return sum;
}

/// Returns the term `sheened` of the formula.
TermSum with_sheen(const Context& context, TermSum base) {
    const MetallicRoughness& model = *context.material.metallic_roughness;
    if (model.sheen_color == glm::vec3(0.0F)) return base;
    const glm::dvec3 color =
        glm::dvec3(model.sheen_color) * glm::dvec3(context.look_up(TextureSlot::sheen_color));
    const Surface& at = context.surface;
    const glm::dvec3& n = at.normal_world;
    const double texel = std::clamp(context.look_up(TextureSlot::sheen_roughness).a, 0.0, 1.0);
    const double alpha = sheen_alpha(static_cast<double>(model.sheen_roughness) * texel);
    const double n_dot_v = std::clamp(glm::dot(n, at.view_world), 0.0, 1.0);
    const PreparedScene& prepared = context.prepared;
    const double albedo =
        model.sheen_roughness_texture
            ? sheen_albedo(prepared.sheen_tables.at(model.sheen_roughness), n_dot_v, texel)
            : sheen_albedo(prepared.sheen_albedos.at(model.sheen_roughness), n_dot_v);
    TermSum sheen = received(context, n, ProbeTermKind::sheen_highlight, "n.l pi D' V'",
                             [&](double n_dot_l, const glm::dvec3& half) {
                                 const double n_dot_h = std::clamp(glm::dot(n, half), 0.0, 1.0);
                                 context.note("n.h", n_dot_h);
                                 context.note("alpha", alpha);
                                 return std::numbers::pi * sheen_distribution(n_dot_h, alpha) *
                                        sheen_visibility(n_dot_l, n_dot_v, alpha);
                             });
    TermSum around = term(context, ProbeTermKind::sheen_ambient, named("La", ambient_of(context)));
    around += term(context, ProbeTermKind::sheen_environment,
                   named("E(n)", environment_irradiance(context)));
    around.multiply(named("occlusion", occlusion(context)));
    sheen += around.multiply(named("E", albedo));
    const double largest = std::max({color.r, color.g, color.b});
    base.multiply(named("1 - max(s) E", 1.0 - largest * albedo));
    base += sheen.multiply(named("sheen color", color));
    return base;
}

/// Returns the term `coated` of the formula.
TermSum with_clearcoat(const Context& context, TermSum base) {
    const MetallicRoughness& model = *context.material.metallic_roughness;
    if (model.clearcoat == 0.0F) return base;
    const double weight =
        static_cast<double>(model.clearcoat) * context.look_up(TextureSlot::clearcoat).r;
    const double roughness = std::max(static_cast<double>(model.clearcoat_roughness) *
                                          context.look_up(TextureSlot::clearcoat_roughness).g,
                                      min_roughness);
    Surface at = context.surface;
    at.normal_world = at.coat_normal_world;
    const Context plain{context.prepared, context.material, at, context.trace};
    const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
    TermSum coat = received(plain, at.normal_world, ProbeTermKind::coat_highlight, "n'.l pi D V",
                            [&](double n_dot_l, const glm::dvec3& half) {
                                return n_dot_l * ggx_lobe(context, at.normal_world, half, at,
                                                          n_dot_l, roughness);
                            });
    // The weight is outside, so the coat's facets mirror all light in all bounces.
    const glm::dvec2 albedo = albedo_of(context, n_dot_v, roughness);
    const double once = albedo.x + albedo.y;
    coat.divide("1 / (A + B)", once);
    TermSum around = term(context, ProbeTermKind::coat_ambient, named("La", ambient_of(context)));
    if (context.prepared.environment) {
        TermSum seen = term(context, ProbeTermKind::coat_reflection, named("A + B", once),
                            named("R", reflected(plain, at.normal_world, roughness)));
        seen += term(context, ProbeTermKind::coat_interreflection, named("1 - A - B", 1.0 - once),
                     named("R", along_normal(plain, 1.0)));
        around += std::move(seen);
    }
    coat += around.multiply(named("occlusion", occlusion(context)));
    const double share = weight * (0.04 + 0.96 * portable::pow(1.0 - n_dot_v, 5.0));
    base.multiply(named("1 - w", 1.0 - share));
    base += coat.multiply(named("w", share));
    return base;
}

TermSum metallic_roughness_radiance(const Context& context, const Hit& hit,
                                    const glm::dvec3& tint) {
    const Surface& at = context.surface;
    const Microfacets facets = microfacets_at(context, tint);
    decide_phase(context, facets);
    TermSum radiance = indirect_light(context, facets);
    radiance.multiply(named("occlusion", occlusion(context)));
    radiance += passing_light(context, facets, hit);
    const glm::dvec3 gain = highlight_gain(context, facets);
    for (const Incoming& light : incoming_light(context, at)) {
        const double n_dot_l = glm::dot(at.normal_world, light.light_world);
        if (!adds_light(context, n_dot_l)) continue;
        radiance += scattered_by(context, facets, light, n_dot_l, gain)
                        .multiply(named("L", light.irradiance), named("n.l", n_dot_l));
    }
    TermSum covered = with_sheen(context, std::move(radiance));
    covered += emitted(context);
    return with_clearcoat(context, std::move(covered));
}

}  // namespace

bool is_transmissive(const Material& material, const Mesh& mesh) {
    const std::optional<MetallicRoughness>& model = material.metallic_roughness;
    return model && !material.unlit && model->transmission > 0.0F &&
           (model->metallic < 1.0F ||
            (model->texture &&
             !(model->texture->second_texcoords ? mesh.texcoords_2 : mesh.texcoords).empty()));
}

Shaded shade(const PreparedScene& prepared, const Hit& hit, const Material& material,
             Trace& trace) {
    const Surface surface = surface_at(prepared, hit, material, trace);
    const Context context{prepared, material, surface, trace};
    const glm::dvec4 texel = context.look_up(TextureSlot::base_color);
    const glm::dvec3 tint = glm::dvec3(texel) * glm::dvec3(surface.color);
    const double alpha = alpha_at(context);
    const bool is_cut = is_clipped(material, surface);
    if (material.unlit) {
        const glm::vec3 color = material.metallic_roughness
                                    ? material.metallic_roughness->base_color
                                    : material.diffuse;
        return {term(context, ProbeTermKind::unlit,
                     named(material.metallic_roughness ? "base color" : "kd", glm::dvec3(color)),
                     named("tint", tint)),
                alpha, is_cut};
    }
    if (material.metallic_roughness)
        return {metallic_roughness_radiance(context, hit, tint), alpha, is_cut};
    return {phong_radiance(context, hit, tint), alpha, is_cut};
}

}  // namespace relief::shade::reference
