// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which triangles around a vertex are neighbours across which edge.
///
/// Two triangles are neighbours when they run along an edge in opposite directions. At an edge with
/// more than two triangles, each has at most one neighbour, chosen by a fixed rule (see
/// corner_links.cpp) that looks at vertices and textures, never at the order of triangles, and
/// gives the same at both ends of the edge. Time is that of sorting the edges of the vertex.
/// Tests: tests/mesh/geometry/tangents/corner_links_test.cpp.
#pragma once

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "geometry/tangents/texture_gradient.h"

namespace relief {

/// An edge of a triangle, seen from the vertex at its end.
struct EdgeUse;

/// Finds neighbours around one vertex after another; keeps its buffers.
class CornerLinker {
  public:
    /// A corner's place in the list of those around its vertex.
    using Place = std::uint32_t;
    static constexpr Place nowhere = std::numeric_limits<Place>::max();

    /// \param triangles  over welded vertices
    CornerLinker(std::span<const glm::uvec3> triangles, std::span<const Gradient> kinds);
    ~CornerLinker();
    CornerLinker(const CornerLinker&) = delete;
    CornerLinker& operator=(const CornerLinker&) = delete;

    /// \param around  the corners at one vertex of the triangles that take part
    void link(std::span<const Corner> around);

    /// Of a corner whose triangle goes on from the vertex to W: the corner at the vertex of the
    /// neighbour across that edge.
    [[nodiscard]] Place across(Place corner) const { return across_[corner]; }
    /// The corner across the edge on which the triangle arrives; the inverse of `across`.
    [[nodiscard]] Place across_previous(Place corner) const { return across_previous_[corner]; }
    /// For a triangle with the same corners in the same order around as another, the corner of the
    /// one among them that counts; for any other its own. Only that one has neighbours.
    [[nodiscard]] Place twin(Place corner) const { return twin_[corner]; }

  private:
    void collect(std::span<const Corner> around);
    void link_edge(std::span<EdgeUse> uses);
    std::span<EdgeUse> without_twins(std::span<EdgeUse> uses);
    void pair_up(std::span<EdgeUse>& leaving, std::span<EdgeUse>& arriving);
    void link(const EdgeUse& leaving, const EdgeUse& arriving);

    std::span<const glm::uvec3> triangles_;
    std::span<const Gradient> kinds_;
    std::vector<EdgeUse> uses_;
    std::vector<Place> across_;
    std::vector<Place> across_previous_;
    std::vector<Place> twin_;
};

/// Whether the corners at a vertex make one chain or one ring: each triangle the neighbour of the
/// next, none left over, no edge with a third. Then neighbours need not be looked for.
///
/// \param next,previous  of each corner: the vertices that its triangle goes on to and comes from;
///                       1 to 16 of them
///
/// Every corner is compared with every other, without branches: for so few, and so often, that is
/// quicker than to look for the one that fits.
inline bool is_single_fan(std::span<const std::uint32_t> next,
                          std::span<const std::uint32_t> previous) {
    constexpr std::size_t most = 16;
    const auto count = static_cast<std::uint32_t>(next.size());
    assert(count >= 1 && count <= most && previous.size() == count);
    std::array<std::uint32_t, most> after;  // The corner across; `count` where there is none.
    std::uint32_t followed = 0;             // A bit for each corner that follows another.
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
        // Nobody may be followed by two, or follow two.
        crowded |= matches > 1 || (matches & (followed >> found)) != 0;
        after[i] = found;
        followed |= matches << found;
        links += matches;
    }
    if (crowded || links + 1 < count) return false;
    // Now there is one chain, and otherwise only rings: from the chain's first, or any corner of a
    // ring, all must be reached.
    const auto first = links == count ? 0U : static_cast<std::uint32_t>(std::countr_one(followed));
    std::uint32_t reached = 1;
    for (std::uint32_t i = after[first]; i != count && i != first; i = after[i])
        ++reached;
    return reached == count;
}

}  // namespace relief
