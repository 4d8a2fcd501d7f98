// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangle corners, and which of them stand at a vertex.
///
/// A corner is numbered 3 * triangle + (0, 1 or 2). Linear time and memory.
/// Tests: tests/mesh/geometry/corners_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace relief {

using Corner = std::uint32_t;

constexpr Corner no_corner = std::numeric_limits<Corner>::max();

inline std::uint32_t triangle_of(Corner corner) {
    return corner / 3;
}

/// The following corner of the same triangle, counter-clockwise.
inline Corner next_in_triangle(Corner corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// The preceding corner of the same triangle.
inline Corner previous_in_triangle(Corner corner) {
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

inline std::uint32_t vertex_of(Corner corner, std::span<const glm::uvec3> triangles) {
    return triangles[corner / 3][static_cast<int>(corner % 3)];
}

/// The corners at every vertex, ascending.
class CornersByVertex {
  public:
    /// A counting sort of the corners of all triangles.
    CornersByVertex(std::size_t vertex_count, std::span<const glm::uvec3> triangles)
        : CornersByVertex(vertex_count, triangles, [](std::size_t) { return true; }) {}

    /// The same of the triangles for which `counts(index)`.
    template <typename Counts>
    CornersByVertex(std::size_t vertex_count, std::span<const glm::uvec3> triangles,
                    const Counts& counts)
        : first_(vertex_count + 1, 0) {
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            if (!counts(t)) continue;
            for (int i = 0; i < 3; ++i)
                ++first_[triangles[t][i] + 1];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        corners_.resize(first_.back());
        std::vector<std::uint32_t> end(first_.begin(), first_.end() - 1);
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            if (!counts(t)) continue;
            for (int i = 0; i < 3; ++i)
                corners_[end[triangles[t][i]]++] =
                    static_cast<Corner>(3 * t) + static_cast<Corner>(i);
        }
    }

    [[nodiscard]] std::size_t vertex_count() const { return first_.size() - 1; }

    [[nodiscard]] std::span<const Corner> at(std::size_t vertex) const {
        return std::span(corners_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }

  private:
    std::vector<std::uint32_t> first_;  ///< Where each vertex's corners begin; one more at the end.
    std::vector<Corner> corners_;
};

}  // namespace relief
