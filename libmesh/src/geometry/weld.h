// SPDX-License-Identifier: Apache-2.0
/// \file
/// Welding: which vertices are equal, exactly or within a distance.
///
/// Exact welding compares numbers: +0 equals -0, an infinity equals itself, and a vertex with a NaN
/// equals no other. Expected time is linear.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief {
/// For every vertex, the smallest index of a vertex with an equal position (its position class).
std::vector<std::uint32_t> weld_positions(std::span<const glm::vec3> positions);

/// The same for vertices that are equal in position, normal and texture coordinate. The spans are
/// equally long.
std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> positions,
                                         std::span<const glm::vec3> normals,
                                         std::span<const glm::vec2> texcoords);

/// For every value, the smallest index of one with the same bits: NaN equals itself there, and +0
/// does not equal -0. For glm::vec2, glm::vec3 and seven floats.
template <typename Value>
std::vector<std::uint32_t> weld_bits(std::span<const Value> values);

/// Groups of two and more, by what the functions above say.
struct Groups {
    /// Where each group begins; one more at the end.
    std::vector<std::uint32_t> first;
    /// Ascending within a group, as groups are by their first.
    std::vector<std::uint32_t> members;

    [[nodiscard]] std::size_t count() const { return first.empty() ? 0 : first.size() - 1; }
    [[nodiscard]] std::span<const std::uint32_t> at(std::size_t group) const {
        return std::span(members).subspan(first[group], first[group + 1] - first[group]);
    }
};
Groups groups_of(std::span<const std::uint32_t> representatives);

/// Triangles over class representatives instead of over vertices.
std::vector<glm::uvec3> welded_triangles(std::span<const glm::uvec3> triangles,
                                         std::span<const std::uint32_t> representatives);

/// For every vertex, the smallest index of one that it is joined with.
///
/// Vertices are joined if they are no further apart than `tolerance`, or joined with the same one:
/// so a chain of near ones is all one, whatever order they come in. Those that are not finite
/// are alone. Distances are taken in double.
///
/// Time: near-linear where few vertices lie within a tolerance of each other, as a tolerance for
/// seams should have it; quadratic in those that crowd at just that distance.
/// \param tolerance  finite and above 0
std::vector<std::uint32_t> weld_near_positions(std::span<const glm::vec3> positions,
                                               double tolerance);

}  // namespace relief
