// SPDX-License-Identifier: Apache-2.0
// Phong's formula in double precision. See phong_reference.h.
#include "phong_reference.h"

#include <algorithm>
#include <cmath>

namespace relief::test {
namespace {

struct Incoming {
    glm::dvec3 direction;  ///< To the light, unit.
    glm::dvec3 irradiance;
};

double fall_off(const PointLight& light, double distance) {
    double share = 1.0;
    if (light.range) {
        share =
            std::clamp(1.0 - std::pow(distance / static_cast<double>(*light.range), 4.0), 0.0, 1.0);
    }
    return share / (distance * distance);
}

Incoming from(const PointLight& light, const glm::dvec3& position) {
    const glm::dvec3 way = glm::dvec3(light.position_world) - position;
    const double distance = glm::length(way);
    return {way / distance, glm::dvec3(light.intensity) * fall_off(light, distance)};
}

double cone_share(const SpotLight& light, const glm::dvec3& to_light) {
    const double cosine = glm::dot(-to_light, glm::normalize(glm::dvec3(light.direction_world)));
    const double inner = std::cos(static_cast<double>(light.inner_cone));
    const double outer = std::cos(static_cast<double>(light.outer_cone));
    const double share = std::clamp((cosine - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
    return share * share;
}

std::vector<Incoming> all_lights(const Scene& scene, const glm::dvec3& position) {
    std::vector<Incoming> result;
    for (const DirectionalLight& light : scene.directional_lights) {
        result.push_back(
            {-glm::normalize(glm::dvec3(light.direction_world)), glm::dvec3(light.irradiance)});
    }
    for (const PointLight& light : scene.point_lights)
        result.push_back(from(light, position));
    for (const SpotLight& light : scene.spot_lights) {
        Incoming incoming = from(light.point, position);
        incoming.irradiance *= cone_share(light, incoming.direction);
        result.push_back(incoming);
    }
    return result;
}

double highlight(const Material& material, const glm::dvec3& n, const glm::dvec3& l,
                 const glm::dvec3& v) {
    const double cosine = material.specular_model == SpecularModel::phong
                              ? glm::dot(2.0 * glm::dot(n, l) * n - l, v)
                              : glm::dot(n, glm::normalize(l + v));
    return std::pow(std::max(cosine, 0.0), static_cast<double>(material.shininess));
}

}  // namespace

glm::dvec3 reference_radiance(const Scene& scene, const Material& material,
                              const ShadedPoint& point, const glm::dvec3& eye) {
    const glm::dvec3 n = point.normal;
    const glm::dvec3 v = glm::normalize(eye - point.position);
    if (material.unlit) return glm::dvec3(material.diffuse) * point.tint;

    glm::dvec3 scattered = glm::dvec3(material.ambient) * point.tint * glm::dvec3(scene.ambient);
    glm::dvec3 highlights(0.0);
    for (const Incoming& light : all_lights(scene, point.position)) {
        const double n_dot_l = glm::dot(n, light.direction);
        if (n_dot_l <= 0.0) continue;
        scattered += light.irradiance * glm::dvec3(material.diffuse) * point.tint * n_dot_l;
        highlights += light.irradiance * glm::dvec3(material.specular) *
                      highlight(material, n, light.direction, v);
    }
    glm::dvec3 fresnel(0.0);
    if (scene.environment && material.reflectivity != glm::vec3(0.0F)) {
        const double m = std::pow(1.0 - std::clamp(glm::dot(n, v), 0.0, 1.0), 5.0);
        const glm::dvec3 normal_incidence(material.reflectivity);
        fresnel =
            normal_incidence + (glm::dvec3(material.grazing_reflectivity) - normal_incidence) * m;
    }
    return (1.0 - fresnel) * scattered + highlights + fresnel * point.mirrored +
           glm::dvec3(material.emission) * point.emission_texture;
}

glm::dvec3 reference_codes(const glm::dvec3& radiance) {
    glm::dvec3 codes;
    for (int i = 0; i < 3; ++i) {
        const double value = std::clamp(radiance[i], 0.0, 1.0);
        codes[i] = 255.0 * (value <= 0.0031308 ? 12.92 * value
                                               : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055);
    }
    return codes;
}

}  // namespace relief::test
