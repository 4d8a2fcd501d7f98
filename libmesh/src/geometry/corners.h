// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangle corners, and which of them stand at a vertex.
///
/// A corner is numbered 3 * triangle + (0, 1 or 2). Linear time and memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <utility>

#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/buffers.h"
#include "work_array.h"

namespace relief::detail {

using Corner = std::uint32_t;

constexpr Corner no_corner = std::numeric_limits<Corner>::max();

inline std::uint32_t triangle_of(Corner corner) {
    return corner / 3;
}

/// Returns the following corner of the same triangle, counter-clockwise.
inline Corner next_in_triangle(Corner corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/// Returns the preceding corner of the same triangle.
inline Corner previous_in_triangle(Corner corner) {
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

inline std::uint32_t vertex_of(Corner corner, TriangleSpan triangles) {
    return triangles[corner / 3][static_cast<int>(corner % 3)];
}

/// Returns the vertices of the corner's triangle, beginning at the corner.
inline glm::uvec3 triangle_from(Corner corner, TriangleSpan triangles) {
    return {vertex_of(corner, triangles), vertex_of(next_in_triangle(corner), triangles),
            vertex_of(previous_in_triangle(corner), triangles)};
}

/// The corners at every vertex, ascending.
class CornersByVertex {
  public:
    /// Counting sort of the corners of all triangles.
    CornersByVertex(std::size_t vertex_count, TriangleSpan triangles)
        : CornersByVertex(vertex_count, triangles, [](std::size_t) { return true; }) {}

    /// Considers only the triangles for which `counts(index)` is true.
    template <typename Counts>
    CornersByVertex(std::size_t vertex_count, TriangleSpan triangles, const Counts& counts)
        : first_(vertex_count + 1) {
        // Each part of the triangles first counts its corners at each vertex, which gives the
        // position of its corners.
        const std::size_t parts = parts_for(vertex_count, triangles.size());
        const auto for_triangles = [&](std::size_t part, const auto& body) {
            const std::size_t end = triangles.size() * (part + 1) / parts;
            for (std::size_t t = triangles.size() * part / parts; t < end; ++t) {
                check_cancelled(t);
                if (counts(t)) body(t);
            }
        };
        WorkArray<std::uint32_t> places(parts * vertex_count);
        parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t part = begin; part < end; ++part) {
                std::uint32_t* const count = places.data() + part * vertex_count;
                std::fill_n(count, vertex_count, 0U);
                for_triangles(part, [&](std::size_t t) {
                    const glm::uvec3 triangle = triangles[t];
                    for (int i = 0; i < 3; ++i)
                        ++count[triangle[i]];
                });
            }
        });
        std::uint32_t next = 0;
        for (std::size_t v = 0; v < vertex_count; ++v) {
            first_[v] = next;
            for (std::size_t part = 0; part < parts; ++part)
                next += std::exchange(places[part * vertex_count + v], next);
        }
        first_[vertex_count] = next;
        corners_ = WorkArray<Corner>(next);
        parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t part = begin; part < end; ++part) {
                std::uint32_t* const place = places.data() + part * vertex_count;
                Corner* const corners = corners_.data();
                for_triangles(part, [&](std::size_t t) {
                    const glm::uvec3 triangle = triangles[t];
                    const auto corner = static_cast<Corner>(3 * t);
                    for (int i = 0; i < 3; ++i)
                        corners[place[triangle[i]]++] = corner + static_cast<Corner>(i);
                });
            }
        });
    }

    [[nodiscard]] std::size_t vertex_count() const { return first_.size() - 1; }

    [[nodiscard]] std::span<const Corner> at(std::size_t vertex) const {
        return {corners_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
    }

  private:
    /// One part per thread, limited so that the counts take no more memory than the corners.
    static std::size_t parts_for(std::size_t vertex_count, std::size_t triangle_count) {
        constexpr std::size_t worth_a_thread = 100'000;
        const std::size_t most = 2 * triangle_count / std::max<std::size_t>(vertex_count, 1);
        return std::clamp<std::size_t>(std::min(triangle_count / worth_a_thread, most), 1,
                                       thread_count());
    }

    WorkArray<std::uint32_t> first_;  ///< Index of each vertex's first corner, and the end.
    WorkArray<Corner> corners_;
};

}  // namespace relief::detail
