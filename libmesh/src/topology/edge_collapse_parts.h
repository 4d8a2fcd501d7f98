// SPDX-License-Identifier: Apache-2.0
/// \file
/// Parts of edge collapses (edge_collapse.h): the connectivity of the surface, and the error of
/// collapses.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "topology/edge_collapse.h"

namespace relief::detail {

/// A corner of the surface.
struct CornerData {
    std::uint32_t vertex;  ///< no_corner in removed triangles.
    std::uint32_t wedge;
    Corner opposite;  ///< As in Topology.
};

/// The triangles around a vertex, counter-clockwise. Spoke i is the edge at which triangle i
/// begins; at a boundary there is one spoke more than triangles.
struct Ring {
    static constexpr std::size_t no_triangle = max_valence;

    std::size_t size = 0;                     ///< Number of triangles.
    std::size_t spokes = 0;                   ///< Number of edges.
    std::size_t lines = 0;                    ///< Number of spokes that are lines.
    bool has_border = false;                  ///< Whether the vertex is at a boundary.
    std::array<Corner, max_valence> corners;  ///< The corner of each triangle at the vertex.
    std::array<std::uint32_t, max_valence + 1> neighbors;  ///< The vertex of each spoke.
    std::array<bool, max_valence + 1> is_line;

    /// The triangle to the left of a spoke, as an index into `corners`; none at a boundary.
    [[nodiscard]] std::size_t left(std::size_t spoke) const {
        return spoke < size ? spoke : no_triangle;
    }
    /// The triangle to the right of a spoke; none at a boundary.
    [[nodiscard]] std::size_t right(std::size_t spoke) const {
        if (spoke > 0) return spoke - 1;
        return has_border ? no_triangle : size - 1;
    }
};

/// A move of a vertex along a spoke of its ring. Where the spoke is a line, the triangles on its
/// two sides have different wedges.
struct Move {
    std::size_t spoke = 0;
    std::uint32_t target = no_corner;
    /// The wedges on the left and on the right before the move; no_corner at a boundary.
    std::array<std::uint32_t, 2> before = {no_corner, no_corner};
    std::array<std::uint32_t, 2> after = {no_corner, no_corner};
};

/// The connectivity of a surface while edges collapse: corners with wedges.
class CollapseSurface {
  public:
    /// Consumes the topology's triangles and neighbors and the wedges.
    explicit CollapseSurface(CollapseInput& input);

    const CornerData& operator[](std::size_t corner) const { return corners_[corner]; }
    /// Three corners for each triangle, also for removed ones.
    [[nodiscard]] std::span<const CornerData> corners() const { return corners_; }
    [[nodiscard]] bool is_removed(std::uint32_t vertex) const {
        return corner_of_[vertex] == no_corner;
    }

    /// Gathers the triangles around a vertex; at a boundary, the ring begins at its clockwise end.
    /// \return false if there are more than max_valence
    [[nodiscard]] bool find_ring(std::uint32_t vertex, Ring& ring) const;

    /// Returns whether the edge that begins at a corner is a line at the end with the given wedge
    /// of the corner's triangle. What differs only at the other end, as at the pole of a sphere,
    /// does not bind this one.
    [[nodiscard]] bool is_line_at(Corner corner, std::uint32_t wedge) const {
        const Corner beyond = corners_[corner].opposite;
        if (beyond == no_corner) return true;
        return wedge != corners_[beyond].wedge && wedge != corners_[next_in_triangle(beyond)].wedge;
    }

    /// Describes the move along a spoke. \return false if lines forbid it
    [[nodiscard]] bool find_move(const Ring& ring, std::size_t spoke, Move& move) const {
        if (ring.lines != 0 && !ring.is_line[spoke]) return false;
        move.spoke = spoke;
        move.target = ring.neighbors[spoke];
        const std::size_t left = ring.left(spoke);
        const std::size_t right = ring.right(spoke);
        move.before = {no_corner, no_corner};
        move.after = {no_corner, no_corner};
        if (left != Ring::no_triangle) {
            move.before[0] = corners_[ring.corners[left]].wedge;
            move.after[0] = corners_[next_in_triangle(ring.corners[left])].wedge;
        }
        if (right != Ring::no_triangle) {
            move.before[1] = corners_[ring.corners[right]].wedge;
            move.after[1] = corners_[previous_in_triangle(ring.corners[right])].wedge;
        }
        if (ring.lines != 0) return true;
        // If the neighbor has two wedges, it is undefined which one the vertex becomes.
        return move.after[0] == move.after[1];
    }

    /// Visits the indices of the triangles that remain.
    template <typename Visit>
    static void for_moved(const Ring& ring, const Move& move, const Visit& visit) {
        const std::size_t left = ring.left(move.spoke);
        const std::size_t right = ring.right(move.spoke);
        for (std::size_t i = 0; i < ring.size; ++i) {
            if (i != left && i != right) visit(i);
        }
    }

    /// Returns the wedge that triangle `index` of the ring gets at its moved corner.
    [[nodiscard]] std::uint32_t wedge_after(const Ring& ring, const Move& move,
                                            std::size_t index) const {
        return corners_[ring.corners[index]].wedge == move.before[0] ? move.after[0]
                                                                     : move.after[1];
    }

    /// Returns whether a removed triangle has lines on both its other sides. The move would join
    /// them, and the last triangle between them, of a texture island or a material, would vanish.
    [[nodiscard]] bool joins_lines(const Ring& ring, const Move& move) const;

    /// The link condition: the surface stays a manifold of the same topology.
    [[nodiscard]] bool keeps_topology(const Ring& ring, const Move& move) const;

    /// Moves a vertex onto its neighbor. \return the number of triangles that it removes
    std::size_t collapse(std::uint32_t vertex, const Ring& ring, const Move& move);

  private:
    [[nodiscard]] bool gather(Corner start, Ring& ring) const;
    [[nodiscard]] bool is_adjacent(std::uint32_t a, std::uint32_t b) const;
    void remove(Corner first, Corner second);

    std::vector<CornerData> corners_;
    std::vector<Corner> corner_of_;  ///< By vertex: a corner there; no_corner if it was removed.
};

/// The quadric p * A * p + 2 b * p + c.
struct Quadric {
    double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
    glm::dvec3 linear{0.0};
    double constant = 0.0;

    /// Adds weight * (slope * p + offset)^2.
    void add(double weight, const glm::dvec3& slope, double offset) {
        const glm::dvec3 weighted = weight * slope;
        xx += weighted.x * slope.x;
        xy += weighted.x * slope.y;
        xz += weighted.x * slope.z;
        yy += weighted.y * slope.y;
        yz += weighted.y * slope.z;
        zz += weighted.z * slope.z;
        linear += weighted * offset;
        constant += weight * offset * offset;
    }

    Quadric& operator+=(const Quadric& other) {
        xx += other.xx;
        xy += other.xy;
        xz += other.xz;
        yy += other.yy;
        yz += other.yz;
        zz += other.zz;
        linear += other.linear;
        constant += other.constant;
        return *this;
    }

    [[nodiscard]] double operator()(const glm::dvec3& p) const {
        const double x = xx * p.x + 2.0 * (xy * p.y + xz * p.z + linear.x);
        const double y = yy * p.y + 2.0 * (yz * p.z + linear.y);
        const double z = zz * p.z + 2.0 * linear.z;
        return x * p.x + y * p.y + z * p.z + constant;
    }
};

/// The maximum root mean square error of a collapse, relative to the size of its connected part: a
/// sphere keeps about 30 triangles.
constexpr double max_part_error = 0.03;

/// The same for collapses without which the number of triangles is out of reach. It keeps a sphere
/// from becoming flat.
constexpr double max_relaxed_part_error = 0.06;

/// The squared distance, in the unit of the points, that counts as 0.
constexpr double collapse_rounding = 1e-15;

/// The errors of collapses: quadrics of distance and attributes. [Garland and Heckbert 1997],
/// [Hoppe 1999]
class CollapseError {
  public:
    /// The input and the surface must outlive this object.
    CollapseError(const CollapseInput& input, const CollapseSurface& surface);

    /// Adds the plane and the attributes of a triangle before any collapse.
    void add_triangle(std::size_t triangle, const glm::dvec3& normal, double doubled_area);

    /// Forgets the planes and attributes of the input, and keeps the mean errors of vertices. Those
    /// of the present surface are added then, and spread_errors() ends it.
    void forget_planes();

    /// Multiplies the mean errors of vertices by the areas that were added.
    void spread_errors();

    /// Adds planes through lines, perpendicular to the triangle, which keep the lines in place.
    void add_lines(std::size_t triangle);

    /// Returns the quadric of the moved vertex at its target.
    [[nodiscard]] double own_cost(std::uint32_t vertex, const Move& move) const {
        const glm::dvec3 p = input_.point(move.target);
        double sum = quadrics_[vertex](p);
        if (sums_per_wedge_ == 0) return sum;
        for (std::size_t side = 0; side < 2; ++side) {
            if (move.before[side] == no_corner || (side == 1 && move.before[1] == move.before[0]))
                continue;
            const double* sums = &attribute_sums_[move.before[side] * sums_per_wedge_];
            const std::span<const float> values = input_.attributes_at(move.after[side]);
            for (std::size_t k = 0; k < values.size(); ++k) {
                const double* s = sums + 4 * k + 1;
                const double value = values[k];
                const double linear = s[0] * p.x + s[1] * p.y + s[2] * p.z + s[3];
                sum += value * (sums[0] * input_.attribute_weights[k] * value - 2.0 * linear);
            }
        }
        return sum;
    }

    [[nodiscard]] double cost(std::uint32_t vertex, const Move& move) const {
        return std::max(0.0, own_cost(vertex, move)) + errors_[move.target];
    }

    /// Returns what collapses are ordered by. A cost, with its squared error, keeps distances
    /// small, but leaves many triangles where the surface is rough. For pictures, which saturate
    /// there, the root mean square to the power of 1.5 counts, times the area that has it. The
    /// error itself makes pictures that are as near, with larger errors of small parts.
    [[nodiscard]] double priority(double cost, std::uint32_t vertex, const Move& move) const {
        if (!input_.for_picture) return cost;
        return std::sqrt(cost * std::sqrt(cost * (areas_[vertex] + areas_[move.target])));
    }

    /// Returns whether a cost is within the maximum error.
    [[nodiscard]] bool is_within_limit(double cost, std::uint32_t vertex, const Move& move) const {
        return !input_.max_error ||
               is_within(*input_.max_error * *input_.max_error, cost, vertex, move);
    }

    /// Returns whether the error is small for the connected part of a vertex.
    [[nodiscard]] bool keeps_part(double cost, std::uint32_t vertex, const Move& move) const {
        if (input_.part_sizes.empty()) return true;
        const double most = part_error_ * input_.part_sizes[vertex];
        return is_within(most * most + input_.attribute_allowance, cost, vertex, move);
    }

    /// Allows twice the errors of connected parts. \return false if they are the largest ones
    bool relax_parts() {
        if (input_.part_sizes.empty() || part_error_ >= max_relaxed_part_error) return false;
        part_error_ *= 2.0;
        return true;
    }

    /// Returns the error (RMS) that a connected part may have, relative to its size.
    [[nodiscard]] double part_error() const { return part_error_; }

    /// Adds the errors of a vertex that moves to those of its target.
    void merge(std::uint32_t vertex, const Move& move);

    /// Returns where a vertex fits the planes and attributes of its quadric best, relative to its
    /// position. Directions that the quadric does not determine are left out.
    [[nodiscard]] glm::dvec3 fitted_offset(std::uint32_t vertex, const Ring& ring) const;

    /// Returns the distance (RMS over the area) of a vertex from the planes of its quadric.
    [[nodiscard]] double plane_distance(std::uint32_t vertex) const;

  private:
    [[nodiscard]] std::span<double> attribute_sums(std::uint32_t wedge) {
        return std::span(attribute_sums_).subspan(wedge * sums_per_wedge_, sums_per_wedge_);
    }
    void add_attributes(std::size_t triangle, const glm::dvec3& normal, double doubled_area);
    /// The quadric of a vertex and its attributes at its position, and half of the gradient there.
    struct Local {
        double value;
        glm::dvec3 slope;
    };
    [[nodiscard]] Local local(std::uint32_t vertex, const Ring& ring) const;
    [[nodiscard]] bool is_within(double squared_error, double cost, std::uint32_t vertex,
                                 const Move& move) const {
        const double area = areas_[vertex] + areas_[move.target];
        return !(cost > (squared_error + collapse_rounding) * area);
    }
    const CollapseInput& input_;
    const CollapseSurface& surface_;
    double part_error_ = max_part_error;
    // By vertex:
    std::vector<Quadric> quadrics_;
    std::vector<double> errors_;  ///< The quadric at the vertex itself, and what it had before.
    std::vector<double> areas_;
    /// By wedge: the sums of weight, and of gradient and offset of each attribute.
    std::vector<double> attribute_sums_;
    std::size_t sums_per_wedge_ = 0;
};

}  // namespace relief::detail
