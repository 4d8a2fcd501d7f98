// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene's lights as rows of four floats, as shaders/light/*.glsl read them. World space.
///
///     directional: (unit direction to the light, 0) (irradiance, 0)
///     point:       (position, 1 / range) (intensity, law)
///     spot:        (position, 1 / range) (intensity, law) (unit axis * cone scale, cone offset)
///
/// each followed by a row (highlight irradiance or intensity, 0) where highlights have colours of
/// their own; first all directional lights, then point lights, then spot lights. 1 / range is 0
/// without a range; law is 1 for the inverse square and 0 for none; cone scale and offset turn the
/// cosine between axis and ray into 1 at the inner cone and 0 at the outer (KHR_lights_punctual).
/// Black lights have no row.
/// Tests: tests/shade/effects/light_rows_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief {

/// How many lamps of all kinds a set of effects has.
std::uint32_t lamp_count(const Features& features);

/// Rows that every OpenGL 3.3 holds in a uniform block (16 KiB); beyond, a buffer texture.
inline constexpr std::uint32_t max_block_rows = 1024;

/// Where each kind starts, and how many rows there are.
struct LightRowLayout {
    std::uint32_t directional_rows = 2;  ///< Of one light.
    std::uint32_t point_rows = 2;
    std::uint32_t spot_rows = 3;
    std::uint32_t first_point = 0;
    std::uint32_t first_spot = 0;
    std::uint32_t count = 0;
};
LightRowLayout light_row_layout(const Features& features);

/// Whether there is any of a colour, negative or not.
inline bool is_not_black(const glm::vec3& color) {
    return color != glm::vec3(0.0F);
}

/// Whether a light gives any light at all.
bool shines(const DirectionalLight& light);
bool shines(const PointLight& light);
bool shines(const SpotLight& light);

/// The rows of all lights that shine; as many of each kind as `features` counts: further ones,
/// which a forced plan may name, are black.
std::vector<glm::vec4> light_rows(const Scene& scene, const Features& features);

}  // namespace relief
