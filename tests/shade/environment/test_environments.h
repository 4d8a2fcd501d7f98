// SPDX-License-Identifier: Apache-2.0
/// \file
/// Test environments: faces from a formula, and integrals over the sphere of faces by brute force.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "environment/environment_images.h"
#include "relief/mesh/image.h"

namespace relief::test {

/// Six faces of float radiance. Each texel holds the radiance in the direction of its center.
inline std::vector<Image> faces_of(int size,
                                   const std::function<glm::dvec3(glm::dvec3)>& radiance) {
    std::vector<Image> faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(size, size, 3, 32, ColorSpace::linear);
        std::size_t i = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const glm::dvec3 value = radiance(glm::normalize(shade::detail::face_direction(
                    face, 2.0 * (x + 0.5) / size - 1.0, 2.0 * (y + 0.5) / size - 1.0)));
                for (int c = 0; c < 3; ++c)
                    image.as<float>()[i++] = static_cast<float>(value[c]);
            }
        }
        faces.push_back(std::move(image));
    }
    return faces;
}

/// Calls visit(unit direction, solid angle, radiance) for every texel.
inline void for_each_texel(
    const std::vector<Image>& faces,
    const std::function<void(const glm::dvec3&, double, const glm::dvec3&)>& visit) {
    const int size = faces[0].width;
    const double side = 2.0 / size;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::dvec2 from(x * side - 1.0, y * side - 1.0);
            const double weight = shade::detail::solid_angle(from, from + side);
            for (std::size_t face = 0; face < 6; ++face) {
                const float* sample =
                    faces[face].as<float>().data() + static_cast<std::size_t>(3 * (y * size + x));
                visit(glm::normalize(shade::detail::face_direction(face, from.x + 0.5 * side,
                                                                   from.y + 0.5 * side)),
                      weight, glm::dvec3(sample[0], sample[1], sample[2]));
            }
        }
    }
}

/// Unit directions with a uniform distribution over the sphere (Fibonacci spiral).
inline std::vector<glm::dvec3> spread_directions(int count) {
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * i + 1.0) / count;
        const double across = std::sqrt(1.0 - y * y);
        const double turn = i * 2.39996322972865332;
        directions.emplace_back(across * std::cos(turn), y, across * std::sin(turn));
    }
    return directions;
}

}  // namespace relief::test
