// SPDX-License-Identifier: Apache-2.0
// Painter's order of triangles by their centres. Tests:
// tests/shade/render/sorted_triangles_test.cpp.
#include "render/sorted_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace relief {

SortedTriangles::SortedTriangles(const Mesh& mesh, const MaterialRange& range) {
    const auto first = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(range.first_triangle);
    triangles_.assign(first, first + static_cast<std::ptrdiff_t>(range.triangle_count));
    centers_.reserve(triangles_.size());
    glm::dvec3 sum(0.0);
    for (const glm::uvec3& t : triangles_) {
        const glm::vec3 center =
            (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F;
        centers_.push_back(center);
        const glm::dvec3 finite(center);
        if (std::isfinite(finite.x + finite.y + finite.z)) sum += finite;
    }
    if (!centers_.empty()) center_ = glm::vec3(sum / static_cast<double>(centers_.size()));
    order_.resize(triangles_.size());
    depths_.resize(triangles_.size());
    sorted_.resize(triangles_.size());
}

std::span<const glm::uvec3> SortedTriangles::sort(const glm::vec3& farther_object) {
    for (std::size_t i = 0; i < centers_.size(); ++i) {
        const float depth = glm::dot(centers_[i], farther_object);
        depths_[i] = std::isfinite(depth) ? depth : -std::numeric_limits<float>::infinity();
    }
    std::iota(order_.begin(), order_.end(), 0U);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return depths_[a] > depths_[b]; });
    for (std::size_t i = 0; i < order_.size(); ++i)
        sorted_[i] = triangles_[order_[i]];
    return sorted_;
}

}  // namespace relief
