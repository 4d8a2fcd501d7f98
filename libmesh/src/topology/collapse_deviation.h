// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far the collapses of edges move a surface from the vertices of the input.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "topology/edge_collapse_parts.h"

namespace relief::detail {

/// Carries the vertices of the input along as samples of its surface: each vertex that remains has
/// those that have moved onto it. A quadric is a mean over area, in which a deep but small dent
/// counts little; the largest distance is that of such dents.
class CollapseDeviation {
  public:
    /// The input, the surface and the positions must outlive this object.
    /// \param positions  of the vertices before any collapse
    CollapseDeviation(const CollapseInput& input, const CollapseSurface& surface,
                      std::span<const glm::vec3> positions);

    /// Returns the largest squared distance of the samples of a vertex from the triangles that it
    /// leaves, and of the middles of new edges from those around it before. Borders are compared
    /// with borders, because a border that is cut straight can lie outside of the input.
    ///
    /// \param enough  smaller squared distances need not be exact; the first larger one is returned
    [[nodiscard]] double squared_distance(std::uint32_t vertex, const Ring& ring, const Move& move,
                                          double enough) const;

    /// Sets the distance that is allowed by a limit of costs (squared error times area): that of an
    /// error at a vertex of mean area, times a factor. Before positions are fitted once more, it is
    /// larger.
    void set_limit(double cost, double mean_area, bool is_before_fit) {
        constexpr double factor = 0.8;
        constexpr double factor_before_fit = 1.4 * factor;
        constexpr double rounding = 1e-7;
        const double used = is_before_fit ? factor_before_fit : factor;
        cost_per_squared_distance_ = mean_area / (factor * factor);
        allowed_ = std::max(used * std::sqrt(cost / mean_area), rounding);
    }
    /// Returns the distance that is allowed; before set_limit(), any.
    [[nodiscard]] double allowed() const { return allowed_; }

    /// Returns the cost for which a squared distance is allowed.
    [[nodiscard]] double cost_of(double squared_distance) const {
        return squared_distance * cost_per_squared_distance_;
    }

    /// Gives the samples of a vertex that moves to its target.
    void merge(std::uint32_t vertex, const Move& move) {
        next_[last_[move.target]] = vertex;
        last_[move.target] = last_[vertex];
    }

  private:
    [[nodiscard]] glm::dvec3 sample(std::uint32_t vertex) const {
        return (glm::dvec3(positions_[vertex]) - input_.center) * input_.scale;
    }

    const CollapseInput& input_;
    const CollapseSurface& surface_;
    std::span<const glm::vec3> positions_;
    // By vertex of the input:
    std::vector<std::uint32_t> next_;  ///< The next sample of the same vertex; no_corner: none.
    std::vector<std::uint32_t> last_;  ///< The last sample of a vertex that remains.
    std::vector<bool> at_border_;
    double allowed_ = std::numeric_limits<double>::infinity();
    double cost_per_squared_distance_ = 0.0;
};

}  // namespace relief::detail
