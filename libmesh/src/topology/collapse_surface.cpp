// SPDX-License-Identifier: Apache-2.0
// The connectivity of collapsing surfaces: rings around vertices, the link condition, and the
// collapse itself. Tests: tests/mesh/topology/decimate_test.cpp.
#include <malloc.h>

#include <utility>

#include "topology/edge_collapse_parts.h"

namespace relief::detail {
namespace {

/// Returns freed memory to the system. The C library keeps blocks of up to 32 MB, which would add a
/// quarter to the peak.
void return_free_memory() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

}  // namespace

CollapseSurface::CollapseSurface(CollapseInput& input) {
    Topology& topology = input.topology;
    const std::size_t triangles = topology.triangles.size();
    corners_.resize(3 * triangles);
    corner_of_.assign(input.positions.size(), no_corner);
    for (std::size_t t = 0; t < triangles; ++t) {
        for (int i = 0; i < 3; ++i) {
            const auto corner = static_cast<Corner>(3 * t + static_cast<std::size_t>(i));
            const std::uint32_t vertex = topology.triangles[t][i];
            corners_[corner] = {vertex, input.wedges[t][i], topology.opposite[corner]};
            corner_of_[vertex] = corner;
        }
    }
    // Positions that are fitted at the end are compared with the surface.
    if (!input.fits_positions) free_memory(topology.triangles);
    free_memory(topology.opposite);
    free_memory(input.wedges);
    return_free_memory();
}

/// Gathers triangles counter-clockwise, beginning at a corner. \return false if there are more than
/// max_valence
bool CollapseSurface::gather(Corner start, Ring& ring) const {
    ring.size = 0;
    ring.lines = 0;
    std::uint32_t wedge = corners_[start].wedge;
    const Corner* const first = ring.corners.data();
    for (Corner corner = start;;) {
        if (ring.size == max_valence) return false;
        ring.corners[ring.size] = corner;
        ring.neighbors[ring.size] = corners_[next_in_triangle(corner)].vertex;
        ring.is_line[ring.size] = corners_[corner].wedge != wedge;
        ring.lines += ring.is_line[ring.size] ? 1 : 0;
        wedge = corners_[corner].wedge;
        ++ring.size;
        const CornerData& previous = corners_[previous_in_triangle(corner)];
        corner = previous.opposite;
        if (corner == *first) {
            ring.has_border = false;
            ring.spokes = ring.size;
            ring.is_line[0] = corners_[corner].wedge != wedge;
            ring.lines += ring.is_line[0] ? 1 : 0;
            return true;
        }
        if (corner != no_corner) continue;
        ring.has_border = true;
        ring.neighbors[ring.size] = previous.vertex;
        ring.spokes = ring.size + 1;
        ring.is_line[0] = true;
        ring.is_line[ring.size] = true;
        ring.lines += 2;
        return true;
    }
}

bool CollapseSurface::find_ring(std::uint32_t vertex, Ring& ring) const {
    Corner start = corner_of_[vertex];
    if (!gather(start, ring)) return false;
    if (!ring.has_border || corners_[start].opposite == no_corner) return true;
    for (std::size_t steps = 0; corners_[start].opposite != no_corner; ++steps) {
        if (steps == max_valence) return false;
        start = next_in_triangle(corners_[start].opposite);
    }
    return gather(start, ring);
}

bool CollapseSurface::joins_lines(const Ring& ring, const Move& move) const {
    const std::size_t left = ring.left(move.spoke);
    if (left != Ring::no_triangle) {
        const Corner beside = next_in_triangle(ring.corners[left]);
        const std::size_t spoke = left + 1 < ring.spokes ? left + 1 : 0;
        if (ring.is_line[spoke] && is_line_at(beside, corners_[beside].wedge)) return true;
    }
    const std::size_t right = ring.right(move.spoke);
    if (right == Ring::no_triangle) return false;
    const Corner beside = next_in_triangle(ring.corners[right]);
    return ring.is_line[right] && is_line_at(beside, corners_[next_in_triangle(beside)].wedge);
}

/// Returns whether two vertices have a common edge; true if both have too many edges to tell.
bool CollapseSurface::is_adjacent(std::uint32_t a, std::uint32_t b) const {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        const Corner given = corner_of_[from];
        Corner corner = given;
        std::size_t steps = 0;
        bool is_whole = false;
        for (; steps < max_valence; ++steps) {
            if (corners_[next_in_triangle(corner)].vertex == to) return true;
            const Corner previous = previous_in_triangle(corner);
            if (corners_[previous].vertex == to) return true;
            corner = corners_[previous].opposite;
            is_whole = corner == given;
            if (is_whole || corner == no_corner) break;
        }
        if (is_whole) return false;
        if (corner != no_corner) continue;
        for (corner = given; steps < max_valence; ++steps) {
            const Corner beyond = corners_[corner].opposite;
            if (beyond == no_corner) return false;
            corner = next_in_triangle(beyond);
            if (corners_[next_in_triangle(corner)].vertex == to) return true;
        }
    }
    return true;
}

bool CollapseSurface::keeps_topology(const Ring& ring, const Move& move) const {
    const auto index_of = [&](std::size_t i) { return i < ring.spokes ? i : i - ring.spokes; };
    for (std::size_t i = 0; i < ring.spokes; ++i) {
        if (i == move.spoke) continue;
        const bool is_beside =
            (ring.left(move.spoke) != Ring::no_triangle && i == index_of(move.spoke + 1)) ||
            (ring.right(move.spoke) != Ring::no_triangle && index_of(i + 1) == move.spoke);
        if (!is_beside && is_adjacent(ring.neighbors[i], move.target)) return false;
    }
    if (ring.has_border || ring.size > 3) return true;
    // The triangle that remains must not lie on the one beyond it, as in a tetrahedron.
    bool is_free = true;
    for_moved(ring, move, [&](std::size_t i) {
        const Corner beyond = corners_[next_in_triangle(ring.corners[i])].opposite;
        if (beyond != no_corner && corners_[previous_in_triangle(beyond)].vertex == move.target)
            is_free = false;
    });
    return is_free;
}

/// Joins what lies beyond two edges that become one.
void CollapseSurface::remove(Corner first, Corner second) {
    const Corner beyond_first = corners_[first].opposite;
    const Corner beyond_second = corners_[second].opposite;
    if (beyond_first != no_corner) corners_[beyond_first].opposite = beyond_second;
    if (beyond_second != no_corner) corners_[beyond_second].opposite = beyond_first;
    // The vertex that is left at the joined edge gets a corner of a triangle that remains.
    const std::uint32_t left_over = corners_[second].vertex;
    if (beyond_first != no_corner) {
        corner_of_[left_over] = beyond_first;
    } else if (beyond_second != no_corner) {
        corner_of_[left_over] = next_in_triangle(beyond_second);
    }
    const Corner start = first - first % 3;
    for (Corner corner = start; corner < start + 3; ++corner)
        corners_[corner].vertex = no_corner;
}

std::size_t CollapseSurface::collapse(std::uint32_t vertex, const Ring& ring, const Move& move) {
    const std::size_t left = ring.left(move.spoke);
    const std::size_t right = ring.right(move.spoke);
    Corner kept = no_corner;
    for_moved(ring, move, [&](std::size_t i) {
        const Corner corner = ring.corners[i];
        corners_[corner].wedge = wedge_after(ring, move, i);
        kept = corner;
    });
    for_moved(ring, move, [&](std::size_t i) { corners_[ring.corners[i]].vertex = move.target; });
    if (kept == no_corner) {
        // Only one triangle is there, and it is removed: the target has one beyond it.
        const Corner corner = ring.corners[0];
        const Corner between = next_in_triangle(corner);
        const Corner beyond = corners_[between].opposite;
        kept = corners_[beyond].vertex == move.target ? beyond : next_in_triangle(beyond);
    }
    if (left != Ring::no_triangle) {
        const Corner corner = ring.corners[left];
        remove(next_in_triangle(corner), previous_in_triangle(corner));
    }
    if (right != Ring::no_triangle) {
        const Corner corner = ring.corners[right];
        remove(corner, next_in_triangle(corner));
    }
    corner_of_[move.target] = kept;
    corner_of_[vertex] = no_corner;
    return (left != Ring::no_triangle ? 1U : 0U) + (right != Ring::no_triangle ? 1U : 0U);
}

}  // namespace relief::detail
