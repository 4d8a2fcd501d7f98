// SPDX-License-Identifier: Apache-2.0
/// \file
/// The axes of what looks at a point from a direction on the sphere. World space; radians. Defined
/// at the poles too. Tests: tests/shade/scene/scene_test.cpp, scene_graph_test.cpp.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace relief {

/// \param azimuth    from +z towards +x
/// \param elevation  above the xz plane
/// \return right, up, and back: the unit vector towards the eye
inline glm::mat3 orbit_axes(double azimuth, double elevation) {
    const glm::dvec3 back(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                          std::cos(azimuth) * std::cos(elevation));
    const glm::dvec3 right(std::cos(azimuth), 0.0, -std::sin(azimuth));
    return {glm::vec3(right), glm::vec3(glm::cross(back, right)), glm::vec3(back)};
}

}  // namespace relief
