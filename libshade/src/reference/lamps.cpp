// SPDX-License-Identifier: Apache-2.0
// Directional, point and spot lights at a point, in double. See lamps.h.
// Source of ranges and cones: KHR_lights_punctual. Tests: tests/shade/reference/shading_test.cpp.
#include "reference/lamps.h"

#include <algorithm>
#include <cmath>

namespace relief::reference {

namespace {

/// Nearer than this a lamp touches the point: what a float can square.
constexpr double touching = 1e-18;

double fall_off(const PointLight& lamp, double distance) {
    double share = lamp.falloff == Falloff::none ? 1.0 : 1.0 / (distance * distance);
    if (lamp.range) {
        const double part = distance / static_cast<double>(*lamp.range);
        share *= std::clamp(1.0 - part * part * part * part, 0.0, 1.0);
    }
    return share;
}

glm::dvec3 limited(const glm::dvec3& irradiance) {
    return glm::min(irradiance, glm::dvec3(static_cast<double>(max_light)));
}

/// \param share  of the lamp's light that its cone lets through in a direction to the lamp
template <typename Share>
void add(const PointLight& lamp, const glm::dvec3& position, Share share,
         std::vector<Incoming>& incoming) {
    const glm::dvec3 way = glm::dvec3(lamp.position_world) - position;
    const double distance = glm::length(way);
    if (!(distance > touching)) return;
    const glm::dvec3 light = way / distance;
    const double factor = fall_off(lamp, distance) * share(light);
    const glm::vec3 highlights = lamp.highlight_intensity.value_or(lamp.intensity);
    incoming.push_back({light, limited(glm::dvec3(lamp.intensity) * factor),
                        limited(glm::dvec3(highlights) * factor)});
}

double cone_share(const SpotLight& lamp, const glm::dvec3& light_world) {
    // Cones closer together than this are one sharp edge (KHR_lights_punctual).
    constexpr double least_difference = 1e-3;
    const double cosine = glm::dot(-light_world, glm::normalize(glm::dvec3(lamp.direction_world)));
    const double inner = std::cos(static_cast<double>(lamp.inner_cone));
    const double outer = std::cos(static_cast<double>(lamp.outer_cone));
    const double share =
        std::clamp((cosine - outer) / std::max(least_difference, inner - outer), 0.0, 1.0);
    return share * share;
}

}  // namespace

std::vector<Incoming> incoming_light(const Scene& scene, const glm::dvec3& position_world) {
    std::vector<Incoming> incoming;
    for (const DirectionalLight& lamp : scene.directional_lights) {
        incoming.push_back({-glm::normalize(glm::dvec3(lamp.direction_world)),
                            glm::dvec3(lamp.irradiance),
                            glm::dvec3(lamp.highlight_irradiance.value_or(lamp.irradiance))});
    }
    for (const PointLight& lamp : scene.point_lights) {
        add(
            lamp, position_world, [](const glm::dvec3&) { return 1.0; }, incoming);
    }
    for (const SpotLight& lamp : scene.spot_lights) {
        add(
            lamp.point, position_world,
            [&](const glm::dvec3& light) { return cone_share(lamp, light); }, incoming);
    }
    return incoming;
}

}  // namespace relief::reference
