// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the lamps of a scene send to a point, as lights.h defines them. World space; irradiances
/// over pi at normal incidence. A lamp that touches the point sends nothing; a close one no more
/// than max_light. Tests: tests/shade/reference/shading_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "relief/shade/scene.h"

namespace relief::reference {

struct Incoming {
    glm::dvec3 light_world;  ///< Unit, to the lamp.
    glm::dvec3 irradiance;
    glm::dvec3 highlight_irradiance;
};

/// Of all lamps but those that touch the point.
std::vector<Incoming> incoming_light(const Scene& scene, const glm::dvec3& position_world);

}  // namespace relief::reference
