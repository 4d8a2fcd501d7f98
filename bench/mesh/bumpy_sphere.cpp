// SPDX-License-Identifier: Apache-2.0
#include "mesh/bumpy_sphere.h"

#include <cmath>
#include <numbers>

namespace relief::bench {

Mesh bumpy_sphere(std::size_t triangles) {
    const auto stacks = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 4.0));
    const std::uint32_t slices = 2 * stacks;
    Mesh mesh;
    for (std::uint32_t stack = 0; stack <= stacks; ++stack) {
        for (std::uint32_t slice = 0; slice <= slices; ++slice) {
            const double u = static_cast<double>(slice) / slices;
            const double v = static_cast<double>(stack) / stacks;
            const double longitude = 2.0 * std::numbers::pi * (slice == slices ? 0.0 : u);
            const double colatitude = std::numbers::pi * v;
            const glm::dvec3 direction(std::sin(colatitude) * std::sin(longitude),
                                       std::cos(colatitude),
                                       std::sin(colatitude) * std::cos(longitude));
            const double radius =
                1.0 + 0.02 * std::sin(24.0 * longitude) * std::sin(24.0 * colatitude);
            mesh.positions.emplace_back(radius * direction);
            mesh.normals.emplace_back(direction);
            mesh.texcoords.emplace_back(u, v);
        }
    }
    for (std::uint32_t stack = 0; stack < stacks; ++stack) {
        for (std::uint32_t slice = 0; slice < slices; ++slice) {
            const std::uint32_t upper_left = stack * (slices + 1) + slice;
            const std::uint32_t lower_left = upper_left + slices + 1;
            mesh.triangles.emplace_back(upper_left, lower_left, lower_left + 1);
            mesh.triangles.emplace_back(upper_left, lower_left + 1, upper_left + 1);
        }
    }
    return mesh;
}

}  // namespace relief::bench
