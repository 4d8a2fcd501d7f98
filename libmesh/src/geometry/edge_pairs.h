// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pairs the triangles at a non-manifold edge, so that surfaces continue across it: triangles that
/// run along the edge in opposite directions are joined, the flattest pair first.
///
/// The result depends on the order of the triangles only if pairs are equally flat. Callers sort
/// the triangles by value first.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "geometry/corners.h"

namespace relief::detail {

/// A triangle at an edge.
struct TriangleAtEdge {
    Corner corner = 0;     ///< The corner of the triangle at which the edge begins.
    bool ascends = false;  ///< Whether the triangle runs from the first end of the edge.
    /// The unit direction of the triangle away from the edge, in its plane; zero without area.
    glm::dvec3 outward{0.0};
    /// Triangles with the same number, the sides of a doubled one, are not joined.
    std::uint32_t stack = 0;
};

/// Returns the direction of a triangle away from an edge, in its plane.
///
/// \param normal  of the triangle
/// \param edge  the direction in which the triangle runs along the edge
inline glm::dvec3 outward_from(const glm::dvec3& normal, const glm::dvec3& edge) {
    const glm::dvec3 across = glm::cross(normal, edge);
    const double length = std::sqrt(glm::dot(across, across));
    return length > 0.0 ? across / length : glm::dvec3(0.0);
}

/// Pairs the triangles of one edge after another.
class EdgePairs {
  public:
    using Pair = std::pair<Corner, Corner>;

    /// Up to 64 triangles, the flattest pair of all that are left is joined again and again. Of
    /// more, those are joined that are each other's flattest partner.
    /// \return the pairs, each with the ascending triangle first; valid until the next call
    std::span<const Pair> join(std::span<const TriangleAtEdge> triangles) {
        forward_.clear();
        backward_.clear();
        pairs_.clear();
        for (const TriangleAtEdge& triangle : triangles)
            (triangle.ascends ? forward_ : backward_).push_back(triangle);
        if (triangles.size() <= max_compared) {
            while (join_flattest()) {
            }
        } else {
            join_mutual();
        }
        return pairs_;
    }

  private:
    static constexpr std::size_t max_compared = 64;
    static constexpr double not_joined = 2.0;  ///< Above all cosines.

    /// The cosine of the angle between two triangles: -1 if they are flat.
    static double cosine(const TriangleAtEdge& a, const TriangleAtEdge& b) {
        return a.stack == b.stack ? not_joined : glm::dot(a.outward, b.outward);
    }

    bool join_flattest() {
        double least = not_joined;
        std::size_t best_i = 0;
        std::size_t best_j = 0;
        for (std::size_t i = 0; i < forward_.size(); ++i) {
            for (std::size_t j = 0; j < backward_.size(); ++j) {
                const double value = cosine(forward_[i], backward_[j]);
                if (value >= least) continue;
                least = value;
                best_i = i;
                best_j = j;
            }
        }
        if (least == not_joined) return false;
        pairs_.emplace_back(forward_[best_i].corner, backward_[best_j].corner);
        forward_.erase(forward_.begin() + static_cast<std::ptrdiff_t>(best_i));
        backward_.erase(backward_.begin() + static_cast<std::ptrdiff_t>(best_j));
        return true;
    }

    void join_mutual() {
        const auto partner = [](const TriangleAtEdge& triangle,
                                const std::vector<TriangleAtEdge>& others) {
            std::size_t index = others.size();
            double least = not_joined;
            for (std::size_t i = 0; i < others.size(); ++i) {
                const double value = cosine(triangle, others[i]);
                if (value >= least) continue;
                least = value;
                index = i;
            }
            return index;
        };
        for (std::size_t i = 0; i < forward_.size(); ++i) {
            const std::size_t j = partner(forward_[i], backward_);
            if (j < backward_.size() && partner(backward_[j], forward_) == i)
                pairs_.emplace_back(forward_[i].corner, backward_[j].corner);
        }
    }

    std::vector<TriangleAtEdge> forward_;
    std::vector<TriangleAtEdge> backward_;
    std::vector<Pair> pairs_;
};

}  // namespace relief::detail
