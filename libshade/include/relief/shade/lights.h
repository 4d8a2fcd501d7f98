// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines directional, point and spot lights as plain data in world space.
///
/// Intensities are irradiances over pi: a white surface that faces a directional light of
/// irradiance 1 has radiance 1. Colors are linear, angles are radians.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace shade {

/// Light from infinitely far away.
struct DirectionalLight {
    /// The direction in which light travels; any length but 0.
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};
    /// Irradiance over pi of a surface that faces the light: the radiance of a white surface.
    glm::vec3 irradiance{1.0F};
    /// The irradiance for highlights, if different; metallic-roughness ignores it.
    std::optional<glm::vec3> highlight_irradiance = std::nullopt;
    glm::vec3 ambient{0.0F};  ///< The ambient light that it adds to the scene's.
    bool on = true;           ///< False: the light is off, and so is its ambient light.
};

/// The decrease of light with distance.
enum class Falloff {
    inverse_square,
    none,  ///< The same at every distance, as in introductory courses.
};

/// Light from a point. Its own position gets no light, and no surface gets more than max_light.
struct PointLight {
    glm::vec3 position_world{0.0F};
    glm::vec3 intensity{1.0F};  ///< Irradiance over pi at distance 1.
    /// The light fades to 0 at this distance (KHR_lights_punctual).
    std::optional<float> range = std::nullopt;
    Falloff falloff = Falloff::inverse_square;
    /// The intensity for highlights, if different; metallic-roughness ignores it.
    std::optional<glm::vec3> highlight_intensity = std::nullopt;
    glm::vec3 ambient{0.0F};  ///< The ambient light that it adds to the scene's, everywhere.
    bool on = true;           ///< False: the light is off, and so is its ambient light.
};

/// A point light within a cone.
struct SpotLight {
    PointLight point;
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};  ///< The cone's axis; any length but 0.
    float inner_cone = 0.0F;          ///< Full intensity within; radians from the axis.
    float outer_cone = 0.785398163F;  ///< No light beyond; above inner_cone, at most pi / 2.
};

/// The maximum irradiance, intensity and ambient radiance of a scene, and of a surface by one light
/// at any distance. Products with it stay finite.
inline constexpr float max_light = 1e18F;

}  // namespace shade
}  // namespace relief
