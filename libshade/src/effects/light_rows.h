// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene's lights as rows of four floats, as shaders/light.glsl reads them. World space.
///
///     directional: (unit direction to the light, 0) (irradiance, 0)
///     point:       (position, 1 / range) (intensity, law)
///     spot:        (position, 1 / range) (intensity, law) (unit axis * cone scale, cone offset)
///
/// each followed by a row (highlight irradiance or intensity, 0) if highlights have colors of their
/// own; first all directional lights, then point lights, then spot lights. 1 / range is 0 without a
/// range; law is 1 for the inverse square and 0 for none; cone scale and offset map the cosine
/// between axis and ray to 1 at the inner cone and 0 at the outer (KHR_lights_punctual). Black
/// lights have no row. Tests: tests/shade/effects/shader_source_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief {

/// The rows that fit a uniform block of every OpenGL 3.3 (16 KiB); more need a buffer texture.
inline constexpr std::uint32_t max_block_rows = 1024;

/// The first row of each kind, and the number of rows.
struct LightRowLayout {
    std::uint32_t directional_rows = 2;  ///< Per light.
    std::uint32_t point_rows = 2;
    std::uint32_t spot_rows = 3;
    std::uint32_t first_point = 0;
    std::uint32_t first_spot = 0;
    std::uint32_t count = 0;
};
LightRowLayout light_row_layout(const Features& features);

/// True if a component is not 0, negative or not.
inline bool is_not_black(const glm::vec3& color) {
    return color != glm::vec3(0.0F);
}

/// True if a light is not black.
bool shines(const DirectionalLight& light);
bool shines(const PointLight& light);
bool shines(const SpotLight& light);

/// Returns the rows of all lights that shine, as many of each kind as `features` counts. A forced
/// plan may count more lights than the scene has: their rows are black.
std::vector<glm::vec4> light_rows(const Scene& scene, const Features& features);

}  // namespace relief
