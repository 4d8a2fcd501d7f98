// SPDX-License-Identifier: Apache-2.0
/// \file
/// Removes vertices of a manifold surface by edge collapses in order of increasing error.
///
/// The error is a quadric of distance and attributes ([Garland and Heckbert 1997], [Hoppe 1999]),
/// in squared units of length weighted by area. A collapse moves a vertex onto a neighbor, so the
/// result uses a subset of the vertices with all their attributes. On request, the vertices that
/// remain move at the end: to the minimum of their quadrics, and beyond it on curved surfaces.
///
/// The work is done in passes. A pass computes the cheapest collapse of each vertex whose cost is
/// unknown (in parallel), takes the cheapest fraction of them as candidates, and executes these on
/// the current surface, in the order of the vertices or, in the last pass, of cost. Groups of
/// neighboring vertices are executed in parallel, then the collapses at their borders. Each
/// collapse examines at most `max_valence` triangles around each of a few vertices, so the time is
/// linear for all shapes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "topology/topology.h"

namespace relief::detail {

/// Frees the memory of a vector, which an assignment of {} would keep.
template <typename T>
void free_memory(std::vector<T>& values) {
    std::vector<T>().swap(values);
}

/// The maximum number of attributes of a wedge: texture coordinates, normal, color and deformation.
constexpr std::size_t max_attributes = 22;

/// The input of collapse_edges(), which consumes it.
struct CollapseInput {
    Topology topology;
    std::vector<glm::vec3> positions;  ///< By vertex of the topology.
    /// (position - center) * scale is within [-1, 1]; the points below are in this space.
    glm::dvec3 center{0.0};
    double scale = 1.0;
    /// For each triangle of the topology, the wedges at its corners. If those of two neighbors
    /// differ along their edge, there is a seam. Different parts have different wedges.
    std::vector<glm::uvec3> wedges;
    std::size_t wedge_count = 0;
    /// Finite attributes by wedge. The first two are texture coordinates if `has_texcoords` is set.
    std::vector<float> attributes;
    /// By attribute: the squared length for which a squared difference of 1 counts.
    std::vector<double> attribute_weights;
    bool has_texcoords = false;
    bool keeps_borders = false;  ///< Vertices at a boundary do not move.
    bool keeps_seams = false;    ///< Vertices at a seam or at the border of a part do not move.
    /// By triangle: the number of triangles that it stands for. Empty: one each.
    std::vector<std::uint32_t> counts;
    /// By vertex, the next one at the same position, in a circle. Such vertices move together,
    /// along lines that all of them have, or not at all. Empty: no vertices share a position.
    std::vector<std::uint32_t> next_at_position;
    bool fits_positions = false;  ///< Remaining vertices move to where they fit the input best.
    std::vector<bool> is_fixed;   ///< By vertex: does not move then. Empty: none.
    /// By vertex: the diagonal of the bounding box of its connected part, in the unit of the
    /// points.
    std::vector<float> part_sizes;
    /// The largest squared error, per area, of attributes that are no lengths. It does not count
    /// against the shape of a part.
    double attribute_allowance = 0.0;
    bool for_picture = false;              ///< See CollapseError::priority().
    bool for_largest_distance = false;     ///< See CollapseDeviation.
    std::optional<std::size_t> triangles;  ///< The number of triangles to stop at.
    /// The maximum error of a collapse: the root of its cost divided by the area, in the unit of
    /// the points.
    std::optional<double> max_error;
    /// The minimum cosine of the angle between the normal of a triangle that changes and the
    /// nearest normal of the input's triangles at each of its vertices. 0 if absent or negative.
    std::optional<double> min_normal_cosine;

    [[nodiscard]] glm::dvec3 point(std::uint32_t vertex) const {
        return (glm::dvec3(positions[vertex]) - center) * scale;
    }
    [[nodiscard]] std::span<const float> attributes_at(std::uint32_t wedge) const {
        const std::size_t count = attribute_weights.size();
        return std::span(attributes).subspan(wedge * count, count);
    }
};

/// Why vertices are left if fewer triangles were requested: how many of them could not move for
/// each reason.
struct Obstacles {
    /// They are at positions where several sheets meet that cannot move together.
    std::size_t non_manifold = 0;
    std::size_t lines = 0;   ///< Lines meet there, end there or must be kept.
    std::size_t limits = 0;  ///< Each move exceeds the maximum error.
    std::size_t parts = 0;   ///< Each move would take its part's shape.
    std::size_t folds = 0;   ///< Each move would turn a triangle over or change the topology.
};

/// The result of collapse_edges().
struct Collapsed {
    /// The triangles of the topology that remain, ascending.
    std::vector<std::uint32_t> remaining;
    std::size_t triangles = 0;       ///< Their number.
    std::vector<glm::uvec3> wedges;  ///< The wedges at the corners of each of these.
    /// New positions of wedges; those at one vertex have the same.
    std::vector<std::pair<std::uint32_t, glm::vec3>> moved;
    std::size_t collapses = 0;
    std::size_t passes = 0;
    /// The number of triangles that were examined, a measure of the work.
    std::size_t examined = 0;
    Obstacles obstacles;
    /// The error (RMS) that connected parts may have, relative to their size, if it was raised.
    std::optional<double> relaxed_part_error;
};

/// Collapses edges until a limit is reached, or no collapse is possible.
///
/// Collapses that flip a triangle, in space or in the texture, make its area zero, change the
/// topology of the surface or merge lines are refused. Seams, borders of parts and boundaries are
/// lines: a vertex on a line moves only along it, and a vertex where lines meet or end does not
/// move. Vertices at one position, where sheets of a surface meet that is not manifold, move
/// together along edges that are boundaries of all these sheets, which therefore stay together.
/// Vertices with more than `max_valence` triangles do not move until collapses around them have
/// reduced that number. Ties: the lower index of a vertex wins.
Collapsed collapse_edges(CollapseInput input);

/// The maximum number of triangles around a vertex that moves.
constexpr std::size_t max_valence = 64;

}  // namespace relief::detail
