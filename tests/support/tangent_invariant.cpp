// SPDX-License-Identifier: Apache-2.0
#include "support/tangent_invariant.h"

#include <fmt/format.h>

#include <cmath>

namespace relief::test {
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
