// SPDX-License-Identifier: Apache-2.0
// Material's formula as material.h states it: Phong's model [Phong 1975], [Blinn 1977], and glTF's
// metallic-roughness (glTF 2.0, appendix B; [Walter et al. 2007]). World space, linear light, in
// double; hard cases as in shaders/README.md. Fresnel's formulas have a complex index of
// refraction. Sources: [Born and Wolf 1999], sections 1.5.2 and 14.2; [Schlick 1994];
// KHR_lights_punctual for ranges and cones.
#include "reference/reference_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <vector>

#include "portable_math.h"
#include "relief/shade/scene.h"

namespace relief::shade::reference {
using namespace relief::detail;
using namespace relief::shade::detail;

// Fresnel

double fresnel(std::complex<double> index, double cosine) {
    if (index == 1.0) return 0.0;
    if (index == 0.0 || cosine <= 0.0) return 1.0;
    // Snell's law: the sine inside is the sine outside divided by the index.
    const std::complex<double> cosine_inside =
        std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const std::complex<double> across =
        (cosine - index * cosine_inside) / (cosine + index * cosine_inside);
    const std::complex<double> along =
        (index * cosine - cosine_inside) / (index * cosine + cosine_inside);
    return 0.5 * (std::norm(across) + std::norm(along));
}

glm::dvec3 fresnel_factor(const Material& material, double n_dot_v) {
    const glm::dvec3 reflectivity(material.reflectivity);
    if (reflectivity == glm::dvec3(0.0)) return glm::dvec3(0.0);
    const double cosine = glm::clamp(n_dot_v, 0.0, 1.0);
    glm::dvec3 factor(0.0);
    switch (material.fresnel) {
        case FresnelModel::schlick:
            factor = reflectivity + (glm::dvec3(material.grazing_reflectivity) - reflectivity) *
                                        portable::pow(1.0 - cosine, 5.0);
            break;
        case FresnelModel::dielectric:
            factor = reflectivity * fresnel(static_cast<double>(material.refractive_index), cosine);
            break;
        case FresnelModel::conductor:
            for (int i = 0; i < 3; ++i) {
                const std::complex<double> index(
                    static_cast<double>(material.conductor_index[i]),
                    static_cast<double>(material.conductor_absorption[i]));
                factor[i] = reflectivity[i] * fresnel(index, cosine);
            }
            break;
    }
    return glm::clamp(factor, 0.0, 1.0);
}

// Thin films

namespace {

/// Returns the color of light whose parts differ by a path in nanometers, relative to white. The
/// sensitivities are Gaussians over wave numbers [Belcour and Barla 2017].
///
/// \param sign  -1 where one part is reflected with the opposite phase, for X, Y and Z
glm::dvec3 interference(double path, const glm::dvec3& sign) {
    struct Gaussian {
        int component;
        double height, position, variance;
    };
    constexpr Gaussian gaussians[] = {{0, 5.4856e-13, 1.6810e6, 4.3278e9},
                                      {1, 4.4201e-13, 1.7953e6, 9.3046e9},
                                      {2, 5.2481e-13, 2.2084e6, 6.6121e9},
                                      {0, 9.7470e-14, 2.2399e6, 4.5282e9}};
    constexpr double white = 1.0685e-7;
    const double phase = 2.0 * std::numbers::pi * path * 1e-9;
    glm::dvec3 xyz(0.0);
    for (const auto& [component, height, position, variance] : gaussians) {
        xyz[component] +=
            sign[component] * height / white * std::sqrt(2.0 * std::numbers::pi * variance) *
            portable::cos(position * phase) * portable::exp(-variance * phase * phase);
    }
    const glm::dmat3 rgb_from_xyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108,
                                  -0.2040259, -0.4985314, 0.0415560, 1.0572252);
    return rgb_from_xyz * xyz;
}

double schlick(double f0, double cosine) {
    return f0 + (1.0 - f0) * portable::pow(1.0 - cosine, 5.0);
}

}  // namespace

glm::dvec3 film_reflectance(const glm::dvec3& f0, double cosine, double index, double thickness) {
    const double cosine_inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double outer = schlick(fresnel(index, 1.0), cosine);
    const double through = 1.0 - outer;
    glm::dvec3 sign(0.0);
    glm::dvec3 from_base(0.0);
    glm::dvec3 amplitude(0.0);
    for (int i = 0; i < 3; ++i) {
        const double root = std::sqrt(std::clamp(f0[i], 0.0, 0.9999));
        const double base_index = (1.0 + root) / (1.0 - root);
        const double inner = schlick(fresnel(base_index / index, 1.0), cosine_inside);
        const double bounce = std::clamp(outer * inner, 1e-5, 0.9999);
        sign[i] = base_index < index ? 1.0 : -1.0;
        from_base[i] = through * through * inner / (1.0 - bounce);
        amplitude[i] = std::sqrt(bounce);
    }
    // The path difference of the first order; orders above 2 are left out.
    const double path = 2.0 * index * thickness * cosine_inside;
    const glm::dvec3 first = (from_base - through) * amplitude;
    return glm::max(outer + from_base + 2.0 * first * interference(path, sign) +
                        2.0 * first * amplitude * interference(2.0 * path, glm::dvec3(1.0)),
                    0.0);
}

// Lights

namespace {

/// The light of one source at a point, as lights.h defines it: irradiance over pi at normal
/// incidence. A light that touches the point sends nothing; a close one no more than max_light.
struct Incoming {
    glm::dvec3 light_world;  ///< Unit, to the light.
    glm::dvec3 irradiance;
    glm::dvec3 highlight_irradiance;
    bool casts_shadow = false;
};

/// A light closer than this touches the point: a float can square this distance.
constexpr double touching = 1e-18;

double fall_off(const PointLight& light, double distance) {
    double share = light.falloff == Falloff::none ? 1.0 : 1.0 / (distance * distance);
    if (light.range) {
        const double part = distance / static_cast<double>(*light.range);
        share *= std::clamp(1.0 - part * part * part * part, 0.0, 1.0);
    }
    return share;
}

glm::dvec3 limited_light(const glm::dvec3& irradiance) {
    return glm::min(irradiance, glm::dvec3(static_cast<double>(max_light)));
}

/// \param share  the fraction of the light that its cone transmits, by the direction to the light
template <typename Share>
void add(const PointLight& light, const glm::dvec3& position, Share share, bool casts_shadow,
         std::vector<Incoming>& incoming) {
    const glm::dvec3 offset = glm::dvec3(light.position_world) - position;
    const double distance = glm::length(offset);
    if (!(distance > touching)) return;
    const glm::dvec3 to_light = offset / distance;
    const double factor = fall_off(light, distance) * share(to_light);
    const glm::vec3 highlights = light.highlight_intensity.value_or(light.intensity);
    incoming.push_back({to_light, limited_light(glm::dvec3(light.intensity) * factor),
                        limited_light(glm::dvec3(highlights) * factor), casts_shadow});
}

double cone_share(const SpotLight& spot, const glm::dvec3& light_world) {
    // Cones with a smaller difference of cosines have a sharp edge (KHR_lights_punctual).
    constexpr double min_difference = 1e-3;
    const double cosine = glm::dot(-light_world, glm::normalize(glm::dvec3(spot.direction_world)));
    const double inner = portable::cos(static_cast<double>(spot.inner_cone));
    const double outer = portable::cos(static_cast<double>(spot.outer_cone));
    const double share =
        std::clamp((cosine - outer) / std::max(min_difference, inner - outer), 0.0, 1.0);
    return share * share;
}

/// Returns the light of all sources but those that touch the point, without shadows.
/// \param casting  the kind of the light that casts a shadow
std::vector<Incoming> all_light(const Scene& scene, ShadowTerm casting,
                                const glm::dvec3& position_world) {
    std::vector<Incoming> incoming;
    bool is_found = false;
    const auto casts = [&](ShadowTerm kind, const auto& light) {
        const bool is_first = kind == casting && !is_found && shines(light);
        is_found |= is_first;
        return is_first;
    };
    for (const DirectionalLight& light : scene.directional_lights) {
        if (!light.on) continue;
        incoming.push_back({-glm::normalize(glm::dvec3(light.direction_world)),
                            glm::dvec3(light.irradiance),
                            glm::dvec3(light.highlight_irradiance.value_or(light.irradiance)),
                            casts(ShadowTerm::directional_light, light)});
    }
    for (const PointLight& light : scene.point_lights) {
        if (!light.on) continue;
        add(
            light, position_world, [](const glm::dvec3&) { return 1.0; },
            casts(ShadowTerm::point_light, light), incoming);
    }
    for (const SpotLight& spot : scene.spot_lights) {
        if (!spot.point.on) continue;
        add(
            spot.point, position_world,
            [&](const glm::dvec3& to_light) { return cone_share(spot, to_light); },
            casts(ShadowTerm::spot_light, spot), incoming);
    }
    return incoming;
}

// Materials

/// The smallest roughness of metallic-roughness. On smoother surfaces, highlights of point lights
/// would vanish.
constexpr double min_roughness = 0.045;

/// A point to be shaded, with its textures.
struct Context {
    const PreparedScene& prepared;
    const Material& material;
    const Surface& surface;
    Trace& trace;

    /// Returns the texel of a slot of the material; white without a texture.
    [[nodiscard]] glm::dvec4 look_up(TextureSlot slot) const {
        const Texture* const texture = find_texture(material, slot);
        if (texture == nullptr) return glm::dvec4(1.0);
        const bool second = texture->second_texcoords;
        if (!(second ? surface.has_texcoord_2 : surface.has_texcoord)) return glm::dvec4(1.0);
        return prepared.texels.look_up(*texture, slot_info(slot).use,
                                       second ? surface.texcoord_2 : surface.texcoord, trace);
    }
};

/// Returns the opacity of a surface, whatever its alpha mode.
double alpha_at(const Context& context) {
    return static_cast<double>(context.material.opacity) *
           context.look_up(TextureSlot::base_color).a * context.surface.color.a *
           context.look_up(TextureSlot::opacity).r;
}

/// Tells whether a surface between a point and the light blocks it.
bool blocks(const PreparedScene& prepared, const Hit& hit, Trace& trace) {
    const Material& material = prepared.material_of(hit.instance, hit.triangle);
    if (!casts_shadow(material)) return false;
    if (material.alpha_mode == AlphaMode::opaque) return true;
    const Surface surface = surface_at(prepared, hit, material, trace);
    return alpha_at({prepared, material, surface, trace}) >=
           static_cast<double>(material.alpha_cutoff);
}

/// Returns the share of the main light that reaches a surface.
double visible_share(const Context& context, const Surface& at) {
    const ShadowCasters& shadow = *context.prepared.shadow;
    const ShadowView& view = shadow.view();
    const glm::dvec3 lifted = at.position_world + view.lift * at.normal_world;
    double visible = 0.0;
    for (const glm::dvec2& point : view.points) {
        const std::vector<Hit> hits = shadow.between(lifted, point);
        const bool blocked = std::any_of(hits.begin(), hits.end(), [&](const Hit& hit) {
            return blocks(context.prepared, hit, context.trace);
        });
        context.trace.decide(blocked ? 1 : 0);
        if (!blocked) visible += 1.0;
    }
    return visible / static_cast<double>(view.points.size());
}

/// Returns the light of all sources but those that touch the point.
std::vector<Incoming> incoming_light(const Context& context, const Surface& at) {
    const std::unique_ptr<ShadowCasters>& shadow = context.prepared.shadow;
    std::vector<Incoming> incoming = all_light(
        context.prepared.scene, shadow ? shadow->view().kind : ShadowTerm::none, at.position_world);
    for (Incoming& light : incoming) {
        if (!light.casts_shadow) continue;
        const double share = visible_share(context, at);
        light.irradiance *= share;
        light.highlight_irradiance *= share;
    }
    return incoming;
}

/// Returns the power of a cosine; 1 for the exponent 0, for every cosine.
double power(double cosine, double exponent) {
    return exponent == 0.0 ? 1.0 : portable::pow(std::max(cosine, 0.0), exponent);
}

/// Returns the term s of the formula.
double highlight(const Material& material, const Surface& at, const glm::dvec3& light) {
    const double shininess = static_cast<double>(material.shininess);
    const glm::dvec3& n = at.normal_world;
    if (material.specular_model == SpecularModel::phong) {
        const glm::dvec3 mirrored = 2.0 * glm::dot(n, light) * n - light;
        return power(glm::dot(mirrored, at.view_world), shininess);
    }
    const glm::dvec3 sum = light + at.view_world;
    const double length = glm::length(sum);
    // An undefined half vector counts as perpendicular to the normal.
    const double cosine = length > 1e-15 ? glm::dot(n, sum) / length : 0.0;
    const double s = power(cosine, shininess);
    const bool normalized = material.specular_model == SpecularModel::blinn_phong_normalized;
    return normalized ? s * (shininess + 2.0) / 8.0 : s;
}

/// Returns the unit half vector, or zero if light and eye are opposite.
glm::dvec3 half_vector(const glm::dvec3& light, const Surface& at) {
    const glm::dvec3 sum = light + at.view_world;
    const double length = glm::length(sum);
    return length > 1e-15 ? sum / length : glm::dvec3(0.0);
}

/// Returns the term k of the formula.
glm::dvec3 highlight_color(const Material& material, const Surface& at, const glm::dvec3& light) {
    const glm::dvec3 specular(material.specular);
    if (!material.highlight_fresnel) return specular;
    const double cosine = std::clamp(glm::dot(at.view_world, half_vector(light, at)), 0.0, 1.0);
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
glm::dvec3 limited(const Context& context, const glm::dvec3& term) {
    return context.prepared.scene.clamp_terms ? glm::clamp(term, 0.0, 1.0) : term;
}

/// The sums over all lights at one point, before they are multiplied by the surface's textures.
struct LightSums {
    glm::dvec3 scattered{0.0};   ///< sum L diffuse max(n.l, 0)
    glm::dvec3 highlights{0.0};  ///< sum H s k [n.l > 0]
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
            limited(context, light.irradiance * n_dot_l * glm::dvec3(context.material.diffuse));
        sums.highlights +=
            limited(context, light.highlight_irradiance *
                                 highlight(context.material, at, light.light_world) *
                                 highlight_color(context.material, at, light.light_world));
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
        const LightSums there =
            light_sums(context, surface_at_corner(context.prepared, hit, corner));
        sums.scattered += there.scattered * hit.barycentric[corner];
        sums.highlights += there.highlights * hit.barycentric[corner];
    }
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

/// Returns the emission of metallic-roughness.
glm::dvec3 emitted(const Context& context) {
    return glm::dvec3(context.material.emission) * emission_texel(context);
}

/// Returns the term N of the formula.
glm::dvec3 environment_tint(const Context& context) {
    const bool has_tint = context.material.environment_tint && context.prepared.environment;
    return has_tint ? along_normal(context, 0.0) : glm::dvec3(1.0);
}

glm::dvec3 phong_radiance(const Context& context, const Hit& hit, const glm::dvec3& tint) {
    const Material& material = context.material;
    const Surface& at = context.surface;
    const glm::dvec3 diffuse(material.diffuse);
    const LightSums lights = interpolated_light_sums(context, hit);
    const glm::dvec3 ambient = limited(context, glm::dvec3(material.ambient) * ambient_of(context));
    const glm::dvec3 around = environment_tint(context);

    const glm::dvec3 scattered =
        around * tint *
        (occlusion(context) *
             (ambient + limited(context, diffuse * environment_irradiance(context))) +
         lights.scattered);
    const glm::dvec3 highlights =
        around * glm::dvec3(context.look_up(TextureSlot::specular)) * lights.highlights;
    // Without an environment there are neither reflections nor transmitted light.
    glm::dvec3 mirrors(0.0);
    double transmission = 0.0;
    if (context.prepared.environment) {
        mirrors = fresnel_factor(material, glm::dot(at.normal_world, at.view_world));
        transmission = static_cast<double>(material.transmission);
    }
    glm::dvec3 radiance =
        highlights + limited(context, glm::dvec3(material.emission)) * emission_texel(context);
    radiance += (1.0 - mirrors) * (1.0 - transmission) * scattered;
    if (mirrors != glm::dvec3(0.0)) {
        const double roughness = static_cast<double>(material.reflection_roughness);
        radiance += mirrors * (material.reflection_by_normal
                                   ? along_normal(context, roughness)
                                   : reflected(context, at.normal_world, roughness));
    }
    if (transmission > 0.0) radiance += (1.0 - mirrors) * transmission * refracted(context);
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
double ggx_lobe(const glm::dvec3& normal, const glm::dvec3& half, const Surface& at, double n_dot_l,
                double roughness) {
    const double alpha = roughness * roughness;
    const double squared = alpha * alpha;
    const double n_dot_v = std::clamp(glm::dot(normal, at.view_world), 0.0, 1.0);
    const double n_dot_h = std::clamp(glm::dot(normal, half), 0.0, 1.0);
    const double spread = n_dot_h * n_dot_h * (squared - 1.0) + 1.0;
    const double distribution = squared / (std::numbers::pi * spread * spread);
    const double visibility =
        0.5 / (n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1.0 - squared) + squared) +
               n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1.0 - squared) + squared));
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
double facet_lobe(const Microfacets& facets, const glm::dvec3& light, const glm::dvec3& half,
                  const Surface& at, double n_dot_l) {
    const Anisotropy& a = facets.anisotropy;
    if (a.strength == 0.0) return ggx_lobe(at.normal_world, half, at, n_dot_l, facets.roughness);
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
    return distribution * 0.5 /
           (n_dot_l * stretched(at.view_world, n_dot_v) + n_dot_v * stretched(light, n_dot_l));
}

/// Returns pi D V f gain + (1 - f') c, the factor of one light.
/// \param n_dot_l  positive  \param gain  highlight_gain()
glm::dvec3 scattered_by(const Context& context, const Microfacets& facets, const glm::dvec3& light,
                        double n_dot_l, const glm::dvec3& gain) {
    const Surface& at = context.surface;
    const glm::dvec3 half = half_vector(light, at);
    if (half == glm::dvec3(0.0)) return facets.scattering;
    const double v_dot_h = std::clamp(glm::dot(at.view_world, half), 0.0, 1.0);
    const double grazing = portable::pow(1.0 - v_dot_h, 5.0);
    const auto [mirrored, blocked] =
        with_film(context, facets, v_dot_h, 1.0,
                  {glm::mix(facets.f0, glm::dvec3(facets.f90), grazing),
                   glm::mix(facets.blocking_f0, glm::dvec3(facets.f90), grazing)});
    return (1.0 - blocked) * facets.scattering +
           mirrored * gain * facet_lobe(facets, light, half, at, n_dot_l);
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
glm::dvec3 indirect_light(const Context& context, const Microfacets& facets) {
    const Surface& at = context.surface;
    const Mirrored facing = with_film(context, facets, 1.0, 1.0, {facets.f0, facets.f0});
    glm::dvec3 light = ambient_of(context) * (facets.scattering + facing.mirrored);
    if (context.prepared.environment) {
        const double n_dot_v = std::clamp(glm::dot(at.normal_world, at.view_world), 0.0, 1.0);
        const glm::dvec2 albedo = albedo_of(context, n_dot_v, facets.roughness);
        const Mirrored once = with_film(context, facets, n_dot_v, albedo.x + albedo.y,
                                        {facets.f0 * albedo.x + facets.f90 * albedo.y,
                                         facets.blocking_f0 * albedo.x + facets.f90 * albedo.y});
        const Mirrored later = bounced(context, facets, n_dot_v, albedo, once);
        light += (1.0 - once.blocked - later.blocked) * facets.scattering *
                 environment_irradiance(context);
        light += once.mirrored * reflected(context, mirror_normal(facets, at), facets.roughness);
        if (later.mirrored != glm::dvec3(0.0)) light += later.mirrored * along_normal(context, 1.0);
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
glm::dvec3 passing_light(const Context& context, const Microfacets& facets, const Hit& hit) {
    const Surface& at = context.surface;
    if (!is_transmissive(context.material, *context.prepared.instances[hit.instance].mesh))
        return glm::dvec3(0.0);
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
    if (model.attenuation_distance) {
        const double lengths = length / static_cast<double>(*model.attenuation_distance);
        const glm::dvec3 color = glm::max(glm::dvec3(model.attenuation_color), 1e-6);
        for (int i = 0; i < 3; ++i)
            light[i] *= portable::pow(color[i], lengths);
    }
    return facets.passing * (1.0 - blocked) * light;
}

/// Returns the sums of light that a layer receives about a normal: sum_i L lobe(n.l, h).
template <typename Lobe>
glm::dvec3 received(const Context& context, const glm::dvec3& normal, Lobe lobe) {
    const Surface& at = context.surface;
    glm::dvec3 sum(0.0);
    for (const Incoming& light : incoming_light(context, at)) {
        const double n_dot_l = glm::dot(normal, light.light_world);
        if (!adds_light(context, n_dot_l)) continue;
        const glm::dvec3 half = half_vector(light.light_world, at);
        if (half != glm::dvec3(0.0)) sum += light.irradiance * lobe(n_dot_l, half);
    }
    return sum;
}

/// Returns the term `sheened` of the formula.
glm::dvec3 with_sheen(const Context& context, const glm::dvec3& base) {
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
    const glm::dvec3 lights = received(context, n, [&](double n_dot_l, const glm::dvec3& half) {
        const double n_dot_h = std::clamp(glm::dot(n, half), 0.0, 1.0);
        return std::numbers::pi * sheen_distribution(n_dot_h, alpha) *
               sheen_visibility(n_dot_l, n_dot_v, alpha);
    });
    const glm::dvec3 around =
        occlusion(context) * (ambient_of(context) + environment_irradiance(context));
    const double largest = std::max({color.r, color.g, color.b});
    return (1.0 - largest * albedo) * base + color * (lights + albedo * around);
}

/// Returns the term `coated` of the formula.
glm::dvec3 with_clearcoat(const Context& context, const glm::dvec3& base) {
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
    glm::dvec3 coat = received(plain, at.normal_world, [&](double n_dot_l, const glm::dvec3& half) {
        return n_dot_l * ggx_lobe(at.normal_world, half, at, n_dot_l, roughness);
    });
    // The weight is outside, so the coat's facets mirror all light in all bounces.
    const glm::dvec2 albedo = albedo_of(context, n_dot_v, roughness);
    const double once = albedo.x + albedo.y;
    coat /= once;
    glm::dvec3 around = ambient_of(context);
    if (context.prepared.environment) {
        around += once * reflected(plain, at.normal_world, roughness) +
                  (1.0 - once) * along_normal(plain, 1.0);
    }
    coat += occlusion(context) * around;
    return glm::mix(base, coat, weight * (0.04 + 0.96 * portable::pow(1.0 - n_dot_v, 5.0)));
}

glm::dvec3 metallic_roughness_radiance(const Context& context, const Hit& hit,
                                       const glm::dvec3& tint) {
    const Surface& at = context.surface;
    const Microfacets facets = microfacets_at(context, tint);
    decide_phase(context, facets);
    glm::dvec3 radiance =
        occlusion(context) * indirect_light(context, facets) + passing_light(context, facets, hit);
    const glm::dvec3 gain = highlight_gain(context, facets);
    for (const Incoming& light : incoming_light(context, at)) {
        const double n_dot_l = glm::dot(at.normal_world, light.light_world);
        if (!adds_light(context, n_dot_l)) continue;
        radiance += light.irradiance * n_dot_l *
                    scattered_by(context, facets, light.light_world, n_dot_l, gain);
    }
    return with_clearcoat(context, with_sheen(context, radiance) + emitted(context));
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
    if (material.unlit) {
        const glm::vec3 color = material.metallic_roughness
                                    ? material.metallic_roughness->base_color
                                    : material.diffuse;
        return {glm::dvec3(color) * tint, alpha};
    }
    if (material.metallic_roughness)
        return {metallic_roughness_radiance(context, hit, tint), alpha};
    return {phong_radiance(context, hit, tint), alpha};
}

}  // namespace relief::shade::reference
