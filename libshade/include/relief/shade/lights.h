// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lamps: directional, point and spot lights, as plain data in world space.
///
/// Intensities are irradiances over pi: a white surface that faces a directional light of
/// irradiance 1 shows radiance 1. Tests: tests/shade/scene/scene_test.cpp,
/// tests/shade/effects/light_rows_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace relief {

/// Light from infinitely far away.
struct DirectionalLight {
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};  ///< The way the light travels; any length but 0.
    /// Of a surface facing it, over pi: a white one then shows this radiance.
    glm::vec3 irradiance{1.0F};
    /// What makes highlights, where that differs; metallic-roughness has no use for it.
    std::optional<glm::vec3> highlight_irradiance = std::nullopt;
};

/// How light from a point gets less with distance.
enum class Falloff {
    inverse_square,
    none,  ///< The same at every distance, as course lamps are.
};

/// Light from a point. It does not reach a point that it touches, and no surface gets more than
/// max_light from it.
struct PointLight {
    glm::vec3 position_world{0.0F};
    glm::vec3 intensity{1.0F};                  ///< Irradiance (over pi, as above) at distance 1.
    std::optional<float> range = std::nullopt;  ///< Fades to 0 there, as KHR_lights_punctual says.
    Falloff falloff = Falloff::inverse_square;
    /// What makes highlights, where that differs; metallic-roughness has no use for it.
    std::optional<glm::vec3> highlight_intensity = std::nullopt;
};

/// A point light within a cone.
struct SpotLight {
    PointLight point;
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};  ///< The cone's axis; any length but 0.
    float inner_cone = 0.0F;          ///< Full intensity within, radians from the axis.
    float outer_cone = 0.785398163F;  ///< None beyond; larger than inner_cone, at most pi / 2.
};

/// The most irradiance, intensity or ambient radiance that a scene may name, and that a surface
/// gets from one light however close: products with it stay finite.
inline constexpr float max_light = 1e18F;

}  // namespace relief
