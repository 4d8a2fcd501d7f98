// SPDX-License-Identifier: Apache-2.0
// The light of all sources at a point, as lights.h defines it, the shadow of the main light, and
// the shadows of a relief on itself. KHR_lights_punctual for ranges and cones.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "portable_math.h"
#include "reference/recorder.h"
#include "reference/shading_parts.h"

namespace relief::shade::reference {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

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
void add(const PointLight& light, const glm::dvec3& position, Share share, Incoming described,
         std::vector<Incoming>& incoming) {
    const glm::dvec3 offset = glm::dvec3(light.position_world) - position;
    const double distance = glm::length(offset);
    if (!(distance > touching)) return;
    described.light_world = offset / distance;
    const double factor = fall_off(light, distance) * share(described.light_world);
    const glm::vec3 highlights = light.highlight_intensity.value_or(light.intensity);
    described.irradiance = limited_light(glm::dvec3(light.intensity) * factor);
    described.highlight_irradiance = limited_light(glm::dvec3(highlights) * factor);
    incoming.push_back(described);
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
    incoming.reserve(scene.directional_lights.size() + scene.point_lights.size() +
                     scene.spot_lights.size());
    bool is_found = false;
    const auto described = [&](ShadowTerm kind, ProbeLightKind listed, const auto& lights,
                               const auto& light) {
        Incoming result{};
        result.casts_shadow = kind == casting && !is_found && shines(light);
        result.kind = listed;
        result.index = static_cast<std::size_t>(&light - lights.data());
        is_found |= result.casts_shadow;
        return result;
    };
    for (const DirectionalLight& light : scene.directional_lights) {
        if (!light.on) continue;
        Incoming& added = incoming.emplace_back(described(ShadowTerm::directional_light,
                                                          ProbeLightKind::directional,
                                                          scene.directional_lights, light));
        added.light_world = -glm::normalize(glm::dvec3(light.direction_world));
        added.irradiance = glm::dvec3(light.irradiance);
        added.highlight_irradiance =
            glm::dvec3(light.highlight_irradiance.value_or(light.irradiance));
    }
    for (const PointLight& light : scene.point_lights) {
        if (!light.on) continue;
        add(
            light, position_world, [](const glm::dvec3&) { return 1.0; },
            described(ShadowTerm::point_light, ProbeLightKind::point, scene.point_lights, light),
            incoming);
    }
    for (const SpotLight& spot : scene.spot_lights) {
        if (!spot.point.on) continue;
        add(
            spot.point, position_world,
            [&](const glm::dvec3& to_light) { return cone_share(spot, to_light); },
            described(ShadowTerm::spot_light, ProbeLightKind::spot, scene.spot_lights, spot),
            incoming);
    }
    return incoming;
}

}  // namespace

double alpha_at(const Context& context) {
    return static_cast<double>(context.material.opacity) *
           context.look_up(TextureSlot::base_color).a * context.surface.color.a *
           context.look_up(TextureSlot::opacity).r;
}

namespace {

/// Tells whether a surface between a point and the light blocks it. The point is in front of a
/// relief that the light meets beyond it.
bool blocks(const PreparedScene& prepared, const Hit& hit, const glm::dvec3& point_world,
            const glm::dvec3& to_light_world, Trace& trace) {
    const Material& material = prepared.material_of(hit.instance, hit.triangle);
    if (!casts_shadow(material)) return false;
    const bool is_opaque = material.alpha_mode == AlphaMode::opaque;
    if (is_opaque && !has_displaced_shadow(material)) return true;
    const Surface surface = surface_at(prepared, hit, material, trace, &to_light_world);
    if (is_clipped(material, surface)) return false;
    if (surface.relief) {
        const glm::dvec3 nearer = surface.relief->beyond * to_light_world;
        const glm::dvec3 relief_world = surface.position_world - nearer;
        if (glm::dot(relief_world - point_world, to_light_world) <= 0.0) return false;
    }
    if (is_opaque) return true;
    return alpha_at({prepared, material, surface, trace}) >=
           static_cast<double>(material.alpha_cutoff);
}

/// Returns the share of the main light that reaches a surface.
double visible_share(const Context& context, const Surface& at) {
    const ShadowCasters& shadow = *context.prepared.shadow;
    const ShadowView& view = shadow.view();
    glm::dvec3 position_world = at.position_world;
    if (at.relief && has_displaced_shadow(context.material))
        position_world -= at.relief->beyond * at.relief->outward_world;
    const glm::dvec3 lifted = position_world + view.lift * at.normal_world;
    const Trace::Unrecorded pause(context.trace);  // What occludes is not on the pixel's ray.
    double visible = 0.0;
    for (const glm::dvec2& point : view.points) {
        const std::vector<Hit> hits = shadow.between(lifted, point);
        const bool blocked = std::any_of(hits.begin(), hits.end(), [&](const Hit& hit) {
            return blocks(context.prepared, hit, lifted, view.to_light(lifted, point),
                          context.trace);
        });
        context.trace.decide(blocked ? 1 : 0);
        if (!blocked) visible += 1.0;
    }
    return visible / static_cast<double>(view.points.size());
}

/// Sets the factors of a light's irradiance at a position.
void describe(const Scene& scene, const Incoming& light, const glm::dvec3& position_world,
              ProbeLight& recorded) {
    if (light.kind == ProbeLightKind::directional) {
        recorded.intensity = glm::dvec3(scene.directional_lights[light.index].irradiance);
        return;
    }
    const bool is_spot = light.kind == ProbeLightKind::spot;
    const PointLight& point =
        is_spot ? scene.spot_lights[light.index].point : scene.point_lights[light.index];
    recorded.intensity = glm::dvec3(point.intensity);
    recorded.falloff =
        fall_off(point, glm::distance(glm::dvec3(point.position_world), position_world));
    if (is_spot) recorded.cone = cone_share(scene.spot_lights[light.index], light.light_world);
}

/// Records a light with its vectors.
/// \param shadow  the share that no surface hides
void record(Recorder& recorder, const Scene& scene, const Surface& at, double shadow,
            Incoming& light) {
    ProbeLight recorded;
    recorded.kind = light.kind;
    recorded.index = light.index;
    recorded.n_dot_l = glm::dot(at.normal_world, light.light_world);
    describe(scene, light, at.position_world, recorded);
    recorded.shadow = shadow;
    recorded.irradiance = light.irradiance;
    recorded.highlight_irradiance = light.highlight_irradiance;
    const std::size_t before = recorder.layer().lights.size();
    light.recorded = recorder.add(recorded);
    if (light.recorded < before) return;  // Another layer of the material has recorded it.
    const glm::dvec3& n = at.normal_world;
    const glm::dvec3& l = light.light_world;
    recorder.add_vector("l", l, light.recorded);
    recorder.add_vector("h", half_vector(l, at), light.recorded);
    recorder.add_vector("r", 2.0 * glm::dot(n, l) * n - l, light.recorded);
}

}  // namespace

glm::dvec3 half_vector(const glm::dvec3& light, const Surface& at) {
    const glm::dvec3 sum = light + at.view_world;
    const double length = glm::length(sum);
    return length > 1e-15 ? sum / length : glm::dvec3(0.0);
}

std::vector<Incoming> incoming_light(const Context& context, const Surface& at) {
    const std::unique_ptr<ShadowCasters>& shadow = context.prepared.shadow;
    const Scene& scene = context.prepared.scene;
    std::vector<Incoming> incoming =
        all_light(scene, shadow ? shadow->view().kind : ShadowTerm::none, at.position_world);
    for (Incoming& light : incoming) {
        double share = 1.0;
        if (light.casts_shadow) {
            share = visible_share(context, at);
        }
        if (at.relief && context.material.height_map->self_shadow) {
            const bool shadowed = is_shadowed(*at.relief, light.light_world);
            context.trace.decide(shadowed ? 1 : 0);
            if (shadowed) share = 0.0;
        }
        light.irradiance *= share;
        light.highlight_irradiance *= share;
        if (Recorder* const recorder = context.recorder())
            record(*recorder, scene, at, share, light);
    }
    return incoming;
}

}  // namespace relief::shade::reference
