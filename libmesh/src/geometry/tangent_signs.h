// SPDX-License-Identifier: Apache-2.0
/// \file
/// Neighbors of triangles around a vertex, and the handedness of every triangle's tangents.
///
/// Two triangles are neighbors if they run along an edge in opposite directions. At an edge with
/// more than two triangles, each has at most one neighbor. A fixed rule chooses it by the values of
/// vertices and by textures, never by the order of triangles and vertices, and gives the same
/// result at both ends of the edge. The time is that of sorting the edges of the vertex. Triangles
/// without a texture gradient take their sign from their neighbors.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "geometry/corners.h"
#include "geometry/gather.h"
#include "geometry/tangent_contributions.h"
#include "geometry/texture_gradient.h"
#include "portable_math.h"

namespace relief::detail {
/// An edge of a triangle, relative to the vertex at its end.
struct EdgeUse;

/// Finds neighbors around one vertex at a time. Reuses its buffers.
class CornerLinker {
  public:
    /// Index of a corner in the list of corners around its vertex.
    using Place = std::uint32_t;
    static constexpr Place nowhere = std::numeric_limits<Place>::max();

    /// \param mesh  triangles with indices of welded vertices
    CornerLinker(const TangentInput& mesh, std::span<const Gradient> kinds);
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
    void sort_by_value(std::span<EdgeUse> uses);
    void pair_up(std::span<EdgeUse>& leaving, std::span<EdgeUse>& arriving);
    void link(const EdgeUse& leaving, const EdgeUse& arriving);

    const TangentInput& mesh_;
    std::span<const Gradient> kinds_;
    std::vector<EdgeUse> uses_;
    std::vector<Place> across_;
    std::vector<Place> across_previous_;
    std::vector<Place> twin_;
};

/// Returns a bit for each of `count` numbers, 8 or 16, that equals `value`.
template <std::size_t count>
RELIEF_INLINE std::uint32_t equal_to(const std::uint32_t* numbers, std::uint32_t value) {
    const auto wanted = static_cast<std::int32_t>(value);
    FourInts mask{};
    for (int i = 0; i < static_cast<int>(count); i += 4) {
        FourInts four;
        std::memcpy(&four, numbers + i, sizeof four);
        mask |= (four == FourInts{wanted, wanted, wanted, wanted}) &
                FourInts{1 << i, 2 << i, 4 << i, 8 << i};
    }
    mask |= __builtin_shufflevector(mask, mask, 2, 3, 0, 1);
    return static_cast<std::uint32_t>(mask[0] | mask[1]);
}

/// The largest number of corners for is_single_fan().
constexpr std::size_t max_single_fan = 16;
using FanVertices = std::array<std::uint32_t, max_single_fan>;

/// Tests whether the corners at a vertex form one chain or one ring: each triangle is the neighbor
/// of the next, none remains, and no edge has a third triangle. Then no search for neighbors is
/// needed.
///
/// \param next,previous  for each corner, the next and the previous vertex of its triangle
/// \param count  the number of corners, at least 1
///
/// Compares all pairs of corners without branches, which is faster than a search for so few
/// corners.
RELIEF_INLINE bool is_single_fan(const FanVertices& next, const FanVertices& previous,
                                 std::uint32_t count) {
    assert(count >= 1 && count <= max_single_fan);
    const std::uint32_t all = (1U << count) - 1;
    std::uint64_t after = 0;     // Four bits for each corner: the corner across, if there is one.
    std::uint32_t followed = 0;  // One bit for each corner that follows another.
    std::uint32_t last = 0;      // One bit for each corner that no other follows.
    bool crowded = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t matches =
            all & (count <= 8 ? equal_to<8>(previous.data(), next[i])
                              : equal_to<max_single_fan>(previous.data(), next[i]));
        // A corner may have only one predecessor and one successor.
        crowded |= (matches & (matches - 1)) != 0 || (matches & followed) != 0;
        followed |= matches;
        last |= matches == 0 ? 1U << i : 0U;
        after |= std::uint64_t(std::countr_zero(matches | 1U << 15)) << (4 * i);
    }
    if (crowded || (last & (last - 1)) != 0) return false;
    // There is at most one chain; everything else is rings. All corners must be reached from the
    // first of the chain, or from any corner of a ring.
    const auto first = last == 0 ? 0U : static_cast<std::uint32_t>(std::countr_one(followed));
    std::uint32_t reached = 1;
    std::uint32_t i = first;
    while ((last >> i & 1U) == 0) {
        i = static_cast<std::uint32_t>(after >> (4 * i)) & 15U;
        if (i == first) break;
        ++reached;
    }
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
/// \param mesh  triangles with indices of welded vertices
/// \param corners    corners of participating triangles
/// \return signs that do not depend on the order of triangles and vertices. The time is linear
///         except for sorting the edges of vertices of triangles without a gradient
TriangleSigns triangle_signs(const TangentInput& mesh, const CornersByVertex& corners,
                             const TriangleGradients& gradients);

}  // namespace relief::detail
