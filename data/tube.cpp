// SPDX-License-Identifier: Apache-2.0
// Tubes: rings of vertices across a curve, each in the plane across it. The first ring of a closed
// tube is repeated at its end, and the first vertex of every ring, for the texture. Object space.
// Tests: tests/mesh/image/sample_data_test.cpp.
#include "tube.h"

#include <cmath>
#include <numbers>

namespace relief::sample {

glm::vec3 rounded(const glm::dvec3& position) {
    return {static_cast<float>(std::round(position.x * 1e5) / 1e5 + 0.0),
            static_cast<float>(std::round(position.y * 1e5) / 1e5 + 0.0),
            static_cast<float>(std::round(position.z * 1e5) / 1e5 + 0.0)};
}

void add_tube(Mesh& mesh, const TubePath& path, int along, int around, glm::dvec2 repeats) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    constexpr double step = 1e-4;
    for (int ring = 0; ring <= along; ++ring) {
        const double share = static_cast<double>(ring) / along;
        const double t = path.closed && ring == along ? 0.0 : share;
        const double before = path.closed ? t - step : std::max(t - step, 0.0);
        const double after = path.closed ? t + step : std::min(t + step, 1.0);
        const glm::dvec3 forward = glm::normalize(path.center(after) - path.center(before));
        const glm::dvec3 side = glm::normalize(glm::cross(forward, path.reference(t)));
        const glm::dvec3 up = glm::cross(side, forward);
        for (int corner = 0; corner <= around; ++corner) {
            const double angle = 2.0 * std::numbers::pi * (corner % around) / around;
            const glm::dvec3 outwards = std::cos(angle) * up + std::sin(angle) * side;
            mesh.positions.push_back(rounded(path.center(t) + path.radius(t) * outwards));
            mesh.texcoords.emplace_back(repeats.x * corner / around, repeats.y * (1.0 - share));
        }
    }
    const auto row = static_cast<std::uint32_t>(around + 1);
    for (std::uint32_t ring = 0; ring < static_cast<std::uint32_t>(along); ++ring) {
        for (std::uint32_t corner = 0; corner + 1 < row; ++corner) {
            const std::uint32_t lower = first + ring * row + corner;
            mesh.triangles.emplace_back(lower, lower + row, lower + 1);
            mesh.triangles.emplace_back(lower + 1, lower + row, lower + row + 1);
        }
    }
}

}  // namespace relief::sample
