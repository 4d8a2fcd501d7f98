// SPDX-License-Identifier: Apache-2.0
/// \file
/// Material's formula (scene.h) at one point, in double precision, written down again from the
/// header and not from the shaders: the CPU twin that pictures are held against.
#pragma once

#include <glm/glm.hpp>

#include "relief/shade/scene.h"

namespace relief::test {

/// What is known at a point; world space.
struct ShadedPoint {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0, 0.0, 1.0};  ///< Unit.
    glm::dvec3 tint{1.0};
    glm::dvec3 emission_texture{1.0};
    glm::dvec3 mirrored{0.0};  ///< The environment in the mirrored direction.
};

glm::dvec3 reference_radiance(const Scene& scene, const Material& material,
                              const ShadedPoint& point, const glm::dvec3& eye);

/// The sRGB code of a radiance, 0 to 255, not rounded.
glm::dvec3 reference_codes(const glm::dvec3& radiance);

}  // namespace relief::test
