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
/// lights have no row. Also the shadow maps of the light that casts a shadow. Tests:
/// tests/shade/effects/shader_source_test.cpp, tests/shade/render/shading_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "relief/export.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade::detail {

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

/// True if a light is on and not black.
bool shines(const DirectionalLight& light);
bool shines(const PointLight& light);
bool shines(const SpotLight& light);

/// Returns the rows of all lights that shine, as many of each kind as `features` counts. A forced
/// plan may count more lights than the scene has: their rows are black.
std::vector<glm::vec4> light_rows(const Scene& scene, const Features& features);

// Shadows

/// Returns whether surfaces of this material cast shadows.
inline bool casts_shadow(const Material& material) {
    const bool transmits =
        material.metallic_roughness && material.metallic_roughness->transmission > 0.0F;
    return material.alpha_mode != AlphaMode::blend && !transmits && !material.unlit;
}

/// The shadow of a scene as its maps show it: a map for each place on the light. All maps have the
/// same depth; places and depths are from 0 to 1.
struct ShadowView {
    ShadowTerm kind = ShadowTerm::none;
    /// The place in the map of the middle of the light, homogeneous.
    glm::dmat4 place_from_world{1.0};
    /// In the map of a point of the light, x and y are displaced by that point times
    /// shift.x * place.z + shift.y * place.w.
    glm::dvec2 shift{0.0};
    std::vector<glm::dvec2> points;  ///< Of the light, within the unit circle.
    int texels = 0;                  ///< The width of a map.
    double lift = 0.0;               ///< Rays begin this far from the surface, along its normal.
    /// The position of the middle of the light, or if w is 0, the direction to it.
    glm::dvec4 light_world{0.0};
    glm::dvec3 right_world{0.0};  ///< The axes of the disc, times its radius.
    glm::dvec3 up_world{0.0};
    glm::dvec3 center_world{0.0};  ///< Of the scene.
    double radius = 0.0;

    /// Returns the vector from a position to a point of the light. For a directional light, it
    /// leaves the scene.
    [[nodiscard]] glm::dvec3 to_light(const glm::dvec3& position_world,
                                      const glm::dvec2& point) const;
    [[nodiscard]] glm::dmat4 clip_from_world(const glm::dvec2& point) const;
    /// Returns the position of a point of the light, or if w is 0, the direction to it.
    [[nodiscard]] glm::dvec4 homogeneous_light(const glm::dvec2& point) const;
};

/// Returns the shadow of a scene; nothing if no light casts one, as Shadow says.
std::optional<ShadowView> shadow_view(const Scene& scene);

/// Returns the kind of the light that casts a shadow; none if nothing does.
ShadowTerm shadow_term(const Scene& scene);

}  // namespace shade::detail
}  // namespace relief
