// SPDX-License-Identifier: Apache-2.0
/// \file
/// Neighbors of triangles around a vertex, and the handedness of every triangle's tangents.
///
/// Two triangles are neighbors if they run along an edge in opposite directions. At an edge with
/// more than two triangles, each has at most one neighbor. A fixed rule chooses it by vertices and
/// textures, never by the order of triangles, and gives the same result at both ends of the edge.
/// The time is that of sorting the edges of the vertex. Triangles without a texture gradient take
/// their sign from their neighbors.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangent_contributions.h"
#include "geometry/texture_gradient.h"

namespace relief {
/// An edge of a triangle, relative to the vertex at its end.
struct EdgeUse;

/// Finds neighbors around one vertex at a time. Reuses its buffers.
class CornerLinker {
  public:
    /// Index of a corner in the list of corners around its vertex.
    using Place = std::uint32_t;
    static constexpr Place nowhere = std::numeric_limits<Place>::max();

    /// \param triangles  with indices of welded vertices
    CornerLinker(TriangleSpan triangles, std::span<const Gradient> kinds);
    ~CornerLinker();
    CornerLinker(const CornerLinker&) = delete;
    CornerLinker& operator=(const CornerLinker&) = delete;

    /// \param around  corners at one vertex, of participating triangles
    void link(std::span<const Corner> around);

    /// For a corner whose triangle continues from the vertex to W: the neighbor's corner at the
    /// vertex, across that edge.
    [[nodiscard]] Place across(Place corner) const { return across_[corner]; }
    /// Returns the corner across the edge on which the triangle arrives. Inverse of `across`.
    [[nodiscard]] Place across_previous(Place corner) const { return across_previous_[corner]; }
    /// For a duplicate triangle (same corners, same winding), the corner of the one that counts;
    /// otherwise the corner itself. Duplicates have no neighbors.
    [[nodiscard]] Place twin(Place corner) const { return twin_[corner]; }

  private:
    void collect(std::span<const Corner> around);
    void link_edge(std::span<EdgeUse> uses);
    std::span<EdgeUse> without_twins(std::span<EdgeUse> uses);
    void pair_up(std::span<EdgeUse>& leaving, std::span<EdgeUse>& arriving);
    void link(const EdgeUse& leaving, const EdgeUse& arriving);

    TriangleSpan triangles_;
    std::span<const Gradient> kinds_;
    std::vector<EdgeUse> uses_;
    std::vector<Place> across_;
    std::vector<Place> across_previous_;
    std::vector<Place> twin_;
};

/// Tests whether the corners at a vertex form one chain or one ring: each triangle is the neighbor
/// of the next, none remains, and no edge has a third triangle. Then no search for neighbors is
/// needed.
///
/// \param next,previous  for each corner, the next and the previous vertex of its triangle; 1 to 16
/// corners
///                       1 to 16 of them
///
/// Compares all pairs of corners without branches, which is faster than a search for so few
/// corners.
inline bool is_single_fan(std::span<const std::uint32_t> next,
                          std::span<const std::uint32_t> previous) {
    constexpr std::size_t most = 16;
    const auto count = static_cast<std::uint32_t>(next.size());
    assert(count >= 1 && count <= most && previous.size() == count);
    std::array<std::uint32_t, most> after;  // The corner across, or `count` if there is none.
    std::uint32_t followed = 0;             // One bit for each corner that follows another.
    std::uint32_t links = 0;
    bool crowded = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t found = count;
        std::uint32_t matches = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            const bool match = previous[k] == next[i];
            found = match ? k : found;
            matches += match ? 1 : 0;
        }
        // A corner may have only one predecessor and one successor.
        crowded |= matches > 1 || (matches & (followed >> found)) != 0;
        after[i] = found;
        followed |= matches << found;
        links += matches;
    }
    if (crowded || links + 1 < count) return false;
    // There is at most one chain; everything else is rings. All corners must be reached from the
    // first of the chain, or from any corner of a ring.
    const auto first = links == count ? 0U : static_cast<std::uint32_t>(std::countr_one(followed));
    std::uint32_t reached = 1;
    for (std::uint32_t i = after[first]; i != count && i != first; i = after[i])
        ++reached;
    return reached == count;
}

/// Returns the sign w from the texture of a triangle; 0 if undefined.
inline std::int8_t sign_of(Gradient kind) {
    return static_cast<std::int8_t>(int(kind == Gradient::upright) -
                                    int(kind == Gradient::mirrored));
}

/// Sign w of every triangle. Stores nothing if all signs follow from the textures.
class TriangleSigns {
  public:
    /// \param found  sign of every triangle, or empty if all signs follow from the textures
    TriangleSigns(std::span<const Gradient> kinds, std::vector<std::int8_t> found)
        : kinds_(kinds), found_(std::move(found)) {}

    /// 1, -1, or 0 if undefined.
    [[nodiscard]] std::int8_t operator[](std::size_t triangle) const {
        return found_.empty() ? sign_of(kinds_[triangle]) : found_[triangle];
    }

  private:
    std::span<const Gradient> kinds_;
    std::vector<std::int8_t> found_;
};

/// Computes the sign w of every triangle. A triangle without a gradient takes the sign of the
/// majority of the triangles with a gradient at the ends of its runs around its vertices, because
/// their groups could include it. If there are none, it takes the majority of the neighbors that
/// have a sign already; +1 if they balance, 0 if there are none. (The reference implementation
/// takes the sign of the first group in the list.)
///
/// \param triangles  with indices of welded vertices
/// \param corners    corners of participating triangles
/// \return signs that do not depend on the order of triangles. The time is linear except for
/// sorting the edges of vertices of triangles without a gradient.
///         of triangles without a gradient
TriangleSigns triangle_signs(TriangleSpan triangles, const CornersByVertex& corners,
                             const TriangleGradients& gradients);

}  // namespace relief
