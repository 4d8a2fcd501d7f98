// SPDX-License-Identifier: Apache-2.0
/// \file
/// Welding: which vertices are equal, exactly or within a distance.
///
/// Exact welding compares numbers: +0 equals -0, an infinity equals itself, and a vertex with a NaN
/// equals no other. Expected time is linear.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <numeric>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/buffers.h"

namespace RELIEF_API relief {
namespace detail {
/// For every vertex, the smallest index of a vertex with an equal position (its position class).
std::vector<std::uint32_t> weld_positions(StridedSpan<const glm::vec3> positions);

/// The same for vertices that are equal in position, normal and texture coordinate. The spans are
/// equally long.
std::vector<std::uint32_t> weld_vertices(StridedSpan<const glm::vec3> positions,
                                         StridedSpan<const glm::vec3> normals,
                                         StridedSpan<const glm::vec2> texcoords);

/// For every value, the smallest index of a value with the same bits: a NaN equals the same NaN,
/// and +0 does not equal -0. Values are glm::vec2, glm::vec3 and seven floats.
template <typename Value>
std::vector<std::uint32_t> weld_bits(std::span<const Value> values);

/// The classes with at least two members.
struct Groups {
    /// The index of each group's first member, and the end.
    std::vector<std::uint32_t> first;
    /// Members are ascending within a group, and groups are in the order of their first members.
    std::vector<std::uint32_t> members;

    [[nodiscard]] std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
    [[nodiscard]] std::span<const std::uint32_t> at(std::size_t group) const {
        return std::span(members).subspan(first[group], first[group + 1] - first[group]);
    }
};
Groups groups_of(std::span<const std::uint32_t> representatives);

/// Triangles over class representatives instead of over vertices.
std::vector<glm::uvec3> welded_triangles(TriangleSpan triangles,
                                         std::span<const std::uint32_t> representatives);
void weld_triangles(TriangleSpan triangles, std::span<const std::uint32_t> representatives,
                    std::span<glm::uvec3> welded);

/// For every vertex, the smallest index of the vertices that it is joined with.
///
/// Vertices are joined if their distance is at most `tolerance`, or if both are joined with a third
/// one. A chain of near vertices is therefore one class, for any order of the input. Vertices that
/// are not finite are not joined. Distances are computed in double.
///
/// The time is nearly linear if few vertices are within the tolerance of each other, as for
/// tolerances of seams. It is quadratic in the number of vertices that are close to that distance.
/// \param tolerance  finite and above 0
std::vector<std::uint32_t> weld_near_positions(StridedSpan<const glm::vec3> positions,
                                               double tolerance);

/// Disjoint sets of numbers that can be joined, in nearly constant time per operation. The
/// representative of each set is its smallest element.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count = 0) { reset(count); }

    /// Starts with `count` sets of one element.
    void reset(std::size_t count) {
        parents_.resize(count);
        std::iota(parents_.begin(), parents_.end(), 0U);
    }

    std::uint32_t find(std::uint32_t element) {
        while (parents_[element] != element) {
            parents_[element] = parents_[parents_[element]];
            element = parents_[element];
        }
        return element;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parents_;
};

}  // namespace detail
}  // namespace relief
