// SPDX-License-Identifier: Apache-2.0
// Lights as numbers for the shaders, in world space; light_rows.h describes the layout. Directions
// are normalized in double precision, so that every length of a float works.
// Tests: tests/shade/effects/shader_source_test.cpp.
#include "effects/light_rows.h"
#include "portable_math.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

glm::vec3 unit(const glm::vec3& direction) {
    return glm::vec3(glm::normalize(glm::dvec3(direction)));
}

glm::vec4 position_row(const PointLight& light) {
    return {light.position_world, light.range ? 1.0F / *light.range : 0.0F};
}

glm::vec4 intensity_row(const PointLight& light) {
    return {light.intensity, light.falloff == Falloff::inverse_square ? 1.0F : 0.0F};
}

void add(std::vector<glm::vec4>& rows, const DirectionalLight& light) {
    rows.emplace_back(-unit(light.direction_world), 0.0F);
    rows.emplace_back(light.irradiance, 0.0F);
}

void add(std::vector<glm::vec4>& rows, const PointLight& light) {
    rows.push_back(position_row(light));
    rows.push_back(intensity_row(light));
}

void add(std::vector<glm::vec4>& rows, const SpotLight& light) {
    // A smaller difference between the cones is one sharp edge (KHR_lights_punctual).
    constexpr double min_difference = 1e-3;
    const double outer = portable::cos(static_cast<double>(light.outer_cone));
    const double inner = portable::cos(static_cast<double>(light.inner_cone));
    const double scale = 1.0 / std::max(inner - outer, min_difference);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(light.direction_world));
    rows.push_back(position_row(light.point));
    rows.push_back(intensity_row(light.point));
    rows.emplace_back(glm::vec3(axis * scale), static_cast<float>(-outer * scale));
}

glm::vec3 highlights_of(const DirectionalLight& light) {
    return light.highlight_irradiance.value_or(light.irradiance);
}
glm::vec3 highlights_of(const PointLight& light) {
    return light.highlight_intensity.value_or(light.intensity);
}
glm::vec3 highlights_of(const SpotLight& light) {
    return highlights_of(light.point);
}

/// Adds the rows of the shining lights of one kind, and black rows up to the planned count.
template <typename Light>
void add_all(std::vector<glm::vec4>& rows, const std::vector<Light>& lights, std::size_t end,
             bool highlight_colors) {
    for (const Light& light : lights) {
        if (!shines(light) || rows.size() >= end) continue;
        add(rows, light);
        if (highlight_colors) rows.emplace_back(highlights_of(light), 0.0F);
    }
    rows.resize(end, glm::vec4(0.0F));
}

}  // namespace

LightRowLayout light_row_layout(const Features& features) {
    const std::uint32_t more = features.highlight_colors ? 1 : 0;
    LightRowLayout layout;
    layout.directional_rows += more;
    layout.point_rows += more;
    layout.spot_rows += more;
    layout.first_point = layout.directional_rows * features.directional_lights;
    layout.first_spot = layout.first_point + layout.point_rows * features.point_lights;
    layout.count = layout.first_spot + layout.spot_rows * features.spot_lights;
    return layout;
}

bool shines(const DirectionalLight& light) {
    return is_not_black(light.irradiance) || is_not_black(highlights_of(light));
}
bool shines(const PointLight& light) {
    return is_not_black(light.intensity) || is_not_black(highlights_of(light));
}
bool shines(const SpotLight& light) {
    return shines(light.point);
}

std::vector<glm::vec4> light_rows(const Scene& scene, const Features& features) {
    const LightRowLayout layout = light_row_layout(features);
    std::vector<glm::vec4> rows;
    rows.reserve(layout.count);
    const bool colors = features.highlight_colors;
    add_all(rows, scene.directional_lights, layout.first_point, colors);
    add_all(rows, scene.point_lights, layout.first_spot, colors);
    add_all(rows, scene.spot_lights, layout.count, colors);
    return rows;
}

}  // namespace relief
