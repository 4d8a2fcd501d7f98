// SPDX-License-Identifier: Apache-2.0
/// \file
/// Height maps, cameras and lights of tests that draw reliefs on a square of the size 4.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "relief/mesh/image.h"
#include "relief/shade/scene.h"

namespace relief::test {

inline constexpr int relief_map_side = 64;
inline constexpr double relief_texel = 4.0 / relief_map_side;  ///< In world units.

/// A camera that looks at the origin at an angle from the z axis, from below.
inline shade::Camera slanted_camera(double degrees) {
    const double angle = glm::radians(degrees);
    const glm::dvec3 eye(0.0, -6.0 * std::sin(angle), 6.0 * std::cos(angle));
    shade::Camera camera;
    camera.world_from_view =
        glm::mat4(glm::inverse(glm::lookAt(eye, glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 1e-9))));
    camera.vertical_fov = 0.6F;
    return camera;
}

/// The same without perspective: the square's sides fill the picture.
inline shade::Camera parallel_camera(double degrees) {
    shade::Camera camera = slanted_camera(degrees);
    camera.orthographic_height = 4.0F;
    return camera;
}

inline Image heights_by(const std::function<double(int x, int y)>& height) {
    constexpr int side = relief_map_side;
    Image image = make_image(side, side, 1, 16, ColorSpace::data);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            image.as<std::uint16_t>()[static_cast<std::size_t>(y * side + x)] =
                static_cast<std::uint16_t>(65535.0 * height(x, y) + 0.5);
    }
    return image;
}

inline Image bumpy_heights() {
    return heights_by([](int x, int y) {
        return 0.5 + 0.3 * std::sin(0.59 * x + 0.1 * y) + 0.2 * std::sin(0.41 * y - 0.23 * x + 1.0);
    });
}

/// A wall on the left, whose floor begins at this column.
inline Image wall_heights(int floor) {
    return heights_by([=](int x, int /*y*/) { return x < floor ? 1.0 : 0.0; });
}

inline Image black_heights() {
    return heights_by([](int, int) { return 0.0; });
}

/// Light from the left, at an angle to the z axis.
inline shade::DirectionalLight light_from_the_left(double degrees) {
    const double angle = glm::radians(degrees);
    shade::DirectionalLight light;
    light.direction_world = glm::vec3(glm::dvec3(std::sin(angle), 0.0, -std::cos(angle)));
    light.irradiance = glm::vec3(1.0F);
    return light;
}

}  // namespace relief::test
