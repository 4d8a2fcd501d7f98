// SPDX-License-Identifier: Apache-2.0
// The distances of samples and of new edges in a collapse. Tests:
// tests/mesh/topology/decimate_test.cpp.
#include "topology/collapse_deviation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>

#include "topology/triangle_distance.h"

namespace relief::detail {
namespace {

double squared_length(const glm::dvec3& v) {
    return glm::dot(v, v);
}

/// A triangle with what many distances from it need.
class Facet {
  public:
    Facet() {}  // NOLINT(modernize-use-equals-default): 64 of them would be filled with zeros.
    explicit Facet(const Corners& corners) : corners_(corners) {
        const glm::dvec3 b = corners[1] - corners[0];
        const glm::dvec3 c = corners[2] - corners[0];
        normal_ = glm::cross(b, c);
        squared_normal_ = squared_length(normal_);
        along_b_ = glm::cross(c, normal_);
        along_c_ = glm::cross(normal_, b);
    }

    /// Returns the squared distance of a point if it is above or below the triangle and within
    /// `enough`; otherwise a larger number. It needs a part of the time of the exact distance.
    [[nodiscard]] double squared_height(const glm::dvec3& p, double enough) const {
        const glm::dvec3 offset = p - corners_[0];
        const double height = glm::dot(normal_, offset);
        const double squared = height * height;
        constexpr double far = std::numeric_limits<double>::infinity();
        if (!(squared <= enough * squared_normal_) || !(squared_normal_ > 0.0)) return far;
        const double b = glm::dot(along_b_, offset);
        const double c = glm::dot(along_c_, offset);
        if (b < 0.0 || c < 0.0 || b + c > squared_normal_) return far;
        return squared / squared_normal_;
    }
    [[nodiscard]] double squared_distance(const glm::dvec3& p) const {
        return detail::squared_distance(p, corners_);
    }

  private:
    Corners corners_;
    glm::dvec3 normal_;
    glm::dvec3 along_b_;  ///< Its product with an offset is the part of edge b, times normal^2.
    glm::dvec3 along_c_;
    double squared_normal_;
};

/// Triangles around a vertex.
class Facets {
  public:
    Facets() {}  // NOLINT(modernize-use-equals-default): as for Facet.
    void add(const Corners& corners) { facets_[size_++] = Facet(corners); }

    /// Returns the squared distance of a point; a number within `enough` need not be the smallest.
    [[nodiscard]] double squared_distance(const glm::dvec3& p, double enough) const {
        for (std::size_t i = 0; i < size_; ++i) {
            const double squared = facets_[i].squared_height(p, enough);
            if (squared <= enough) return squared;
        }
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < size_ && least > enough; ++i)
            least = std::min(least, facets_[i].squared_distance(p));
        return least;
    }

  private:
    std::size_t size_ = 0;
    std::array<Facet, max_valence> facets_;
};

double squared_distance_from_edge(const glm::dvec3& p, const glm::dvec3& from,
                                  const glm::dvec3& to) {
    const glm::dvec3 edge = to - from;
    const double length = squared_length(edge);
    const double along =
        length > 0.0 ? std::clamp(glm::dot(edge, p - from) / length, 0.0, 1.0) : 0.0;
    return squared_length(p - from - along * edge);
}

}  // namespace

CollapseDeviation::CollapseDeviation(const CollapseInput& input, const CollapseSurface& surface,
                                     std::span<const glm::vec3> positions)
    : input_(input),
      surface_(surface),
      positions_(positions),
      next_(positions.size(), no_corner),
      last_(positions.size()),
      at_border_(positions.size(), false) {
    std::iota(last_.begin(), last_.end(), 0U);
    for (Corner corner = 0; corner < surface.corners().size(); ++corner) {
        if (surface[corner].opposite != no_corner) continue;
        at_border_[surface[corner].vertex] = true;
        at_border_[surface[next_in_triangle(corner)].vertex] = true;
    }
}

double CollapseDeviation::squared_distance(std::uint32_t vertex, const Ring& ring, const Move& move,
                                           double enough) const {
    const glm::dvec3 target = input_.point(move.target);
    const glm::dvec3 origin = input_.point(vertex);
    const auto triangle_from = [&](const glm::dvec3& first, std::size_t i) {
        return Corners{first, input_.point(surface_[next_in_triangle(ring.corners[i])].vertex),
                       input_.point(surface_[previous_in_triangle(ring.corners[i])].vertex)};
    };
    Facets after;
    CollapseSurface::for_moved(ring, move,
                               [&](std::size_t i) { after.add(triangle_from(target, i)); });
    glm::dvec3 border_end(0.0);
    if (ring.has_border)
        border_end = input_.point(ring.neighbors[move.spoke == 0 ? ring.spokes - 1 : 0]);
    double largest = 0.0;
    for (std::uint32_t s = vertex; s != no_corner && largest <= enough; s = next_[s]) {
        const glm::dvec3 p = sample(s);
        const double from_target = squared_length(p - target);
        if (from_target <= enough) {
            largest = std::max(largest, std::min(from_target, enough));
        } else if (ring.has_border && at_border_[s]) {
            largest = std::max(largest, squared_distance_from_edge(p, target, border_end));
        } else {
            largest = std::max(largest, after.squared_distance(p, enough));
        }
    }
    if (largest > enough) return largest;

    std::optional<Facets> before;
    for (std::size_t k = 0; k < ring.spokes && largest <= enough; ++k) {
        const std::size_t steps = k > move.spoke ? k - move.spoke : move.spoke - k;
        if (steps <= 1 || (!ring.has_border && steps + 1 == ring.spokes)) continue;
        const glm::dvec3 end = input_.point(ring.neighbors[k]);
        const glm::dvec3 middle = 0.5 * (end + target);
        if (ring.has_border && (k == 0 || k + 1 == ring.spokes)) {
            largest =
                std::max(largest, std::min(squared_distance_from_edge(middle, end, origin),
                                           squared_distance_from_edge(middle, origin, target)));
            continue;
        }
        if (!before) {
            before.emplace();
            for (std::size_t i = 0; i < ring.size; ++i)
                before->add(triangle_from(origin, i));
        }
        largest = std::max(largest, before->squared_distance(middle, enough));
    }
    return largest;
}

}  // namespace relief::detail
