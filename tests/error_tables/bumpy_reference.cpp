// SPDX-License-Identifier: Apache-2.0
#include "error_tables/bumpy_reference.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace relief::test {
namespace {

constexpr int lines_per_side = 16;
constexpr std::size_t texel_stride = 37;

/// The point of the low mesh at a texture coordinate, and its interpolated normal.
struct LowPoint {
    glm::dvec3 position{0.0};
    glm::dvec3 outward{0.0};
};

LowPoint low_point(const Mesh& low, const LowSphere& shape, double u, double v) {
    const double x = u * shape.slices;
    const double y = v * shape.stacks;
    const auto cell =
        static_cast<std::size_t>(std::floor(y)) * static_cast<std::size_t>(shape.slices) +
        static_cast<std::size_t>(std::floor(x));
    for (const std::size_t index : {2 * cell, 2 * cell + 1}) {
        const glm::uvec3& t = low.triangles[index];
        const auto at = [&](std::uint32_t corner) { return glm::dvec2(low.texcoords[corner]); };
        const glm::dvec2 a = at(t.x), e = at(t.y) - a, f = at(t.z) - a, p = glm::dvec2(u, v) - a;
        const double area = e.x * f.y - e.y * f.x;
        const double second = (p.x * f.y - p.y * f.x) / area;
        const double third = (e.x * p.y - e.y * p.x) / area;
        if (std::min({second, third, 1.0 - second - third}) < -1e-6) continue;
        const auto mixed = [&](const std::vector<glm::vec3>& values) {
            return (1.0 - second - third) * glm::dvec3(values[t.x]) +
                   second * glm::dvec3(values[t.y]) + third * glm::dvec3(values[t.z]);
        };
        return {mixed(low.positions), glm::normalize(mixed(low.normals))};
    }
    throw std::logic_error("a texel lies on no triangle");
}

TexelReference reference_of(const accuracy::detail::BumpySphere& high, const Mesh& low,
                            const LowSphere& shape, int map_side, std::size_t texel) {
    TexelReference reference{texel};
    const auto add = [&](double x, double y, glm::dvec3& surface, glm::dvec3& mesh) {
        const LowPoint point = low_point(low, shape, x / map_side, y / map_side);
        const glm::dvec3 from = point.position + 0.05 * point.outward;
        surface += accuracy::detail::BumpySphere::on_surface(from, -point.outward).normal;
        mesh += high.on_mesh(from, -point.outward).normal;
    };
    const auto x = static_cast<double>(texel % static_cast<std::size_t>(map_side));
    const auto y = static_cast<double>(texel / static_cast<std::size_t>(map_side));
    for (int i = 0; i < lines_per_side * lines_per_side; ++i) {
        add(x + (i % lines_per_side + 0.5) / lines_per_side,
            y + (i / lines_per_side + 0.5) / lines_per_side, reference.surface, reference.mesh);
    }
    add(x + 0.5, y + 0.5, reference.surface_middle, reference.mesh_middle);
    return reference;
}

}  // namespace

std::vector<TexelReference> texel_references(const accuracy::detail::BumpySphere& high,
                                             const Mesh& low, const LowSphere& shape,
                                             int map_side) {
    std::vector<TexelReference> all;
    const auto side = static_cast<std::size_t>(map_side);
    const std::size_t first = side * (side / 10);
    for (std::size_t texel = first; texel < side * side - first; texel += texel_stride)
        all.push_back(reference_of(high, low, shape, map_side, texel));
    return all;
}

}  // namespace relief::test
