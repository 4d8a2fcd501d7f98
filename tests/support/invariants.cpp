// SPDX-License-Identifier: Apache-2.0
#include "support/invariants.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <random>

namespace relief::test {

Mesh with_triangle_order(const Mesh& mesh, const std::vector<std::size_t>& order) {
    Mesh result = mesh;
    for (std::size_t i = 0; i < order.size(); ++i)
        result.triangles[i] = mesh.triangles[order[i]];
    return result;
}

std::vector<std::size_t> shuffled(std::size_t count, std::uint32_t seed) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 generator(seed);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[generator() % i]);
    return order;
}

std::vector<std::size_t> reversed(std::size_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.rbegin(), order.rend(), std::size_t{0});
    return order;
}

std::vector<glm::vec4> corners_in_order(const std::vector<glm::vec4>& values,
                                        const std::vector<std::size_t>& order) {
    std::vector<glm::vec4> result;
    for (const std::size_t triangle : order) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
        result.insert(result.end(), first, first + 3);
    }
    return result;
}

namespace {

constexpr double tolerance = 1e-6;

std::string broken_tangent(const glm::vec4& tangent, const glm::vec3& vertex_normal) {
    const glm::dvec3 direction(tangent);
    const double length = glm::length(direction);
    if (!(std::abs(length - 1.0) <= tolerance)) return fmt::format("has length {}", length);
    if (std::abs(tangent.w) != 1.0F) return fmt::format("has w {}", tangent.w);
    const double normal_length = glm::length(glm::dvec3(vertex_normal));
    if (!(normal_length > 0.0) || !std::isfinite(normal_length)) return "";
    const double cosine = glm::dot(direction, glm::dvec3(vertex_normal) / normal_length);
    if (std::abs(cosine) > tolerance) return fmt::format("leans by {} on its normal", cosine);
    return "";
}

}  // namespace

std::string broken_tangents(const Mesh& mesh, const std::vector<glm::vec4>& tangents) {
    if (tangents.size() != 3 * mesh.triangles.size()) {
        return fmt::format("{} tangents for {} triangles", tangents.size(), mesh.triangles.size());
    }
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::uint32_t vertex = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        const std::string problem = broken_tangent(tangents[corner], mesh.normals[vertex]);
        if (!problem.empty()) return fmt::format("the tangent of corner {} {}", corner, problem);
        if (tangents[corner].w != tangents[corner / 3 * 3].w)
            return fmt::format("triangle {} has both handednesses", corner / 3);
    }
    return "";
}

}  // namespace relief::test
