// SPDX-License-Identifier: Apache-2.0
// From directions to places in a light probe, in double; the twin in GLSL is in
// gl/cube_map_projection.cpp. See angular_map.h. Tests:
// tests/shade/environment/angular_map_test.cpp.
#include "environment/angular_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"

namespace relief {

double angular_map_reach(int width) {
    return std::max(0.0, 1.0 - 2.0 * angular_map_rim / width);
}

glm::dvec2 angular_map_place(const glm::dvec3& direction, int width) {
    const double across = std::hypot(direction.x, direction.y);
    const double angle = std::atan2(across, -direction.z) / std::numbers::pi;
    const double radius = std::min(angle, angular_map_reach(width));
    const glm::dvec2 side = across > 0.0 ? glm::dvec2(direction) / across : glm::dvec2(1.0, 0.0);
    return {0.5 + 0.5 * radius * side.x, 0.5 - 0.5 * radius * side.y};
}

void check_angular_map(const Image& image, std::string_view name) {
    if (image.empty()) throw InvalidInput(fmt::format("angular map '{}' has no texels", name));
    if (image.width != image.height) {
        throw InvalidInput(fmt::format("angular map '{}' has {} x {} texels, but must be square",
                                       name, image.width, image.height));
    }
}

}  // namespace relief
