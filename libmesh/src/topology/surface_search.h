// SPDX-License-Identifier: Apache-2.0
/// \file
/// Searches the nearest triangle of a surface, on a bounding volume hierarchy.
///
/// The triangles of the hierarchy are sorted along a curve through space and grouped in pairs, so
/// it is a complete binary tree in an array. Axis-aligned boxes of long, thin triangles overlap: in
/// a fan, a point is in the boxes of a large part of the triangles. Nodes with such triangles have
/// a second bound, an oriented prism. If they cross each other in all directions, prisms do not
/// help; then the triangles are divided into slabs with boxes of their own, which refer to the
/// whole triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "relief/mesh/mesh.h"
#include "topology/triangle_distance.h"

namespace relief::detail {

/// The work of a search: the number of examined boxes, a triangle counting as four.
using SearchWork = std::uint64_t;

/// The triangle that is nearest to a point.
struct NearestTriangle {
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = 0;  ///< Index in the surface.
};

/// The finite triangles of a mesh, with a hierarchy.
class SurfaceSearch {
  public:
    explicit SurfaceSearch(const Mesh& mesh);

    [[nodiscard]] std::size_t size() const { return triangles_.size(); }
    [[nodiscard]] Corners corners(std::size_t triangle) const {
        const auto& at = corners_[triangle];
        return {glm::dvec3(at[0]), glm::dvec3(at[1]), glm::dvec3(at[2])};
    }
    [[nodiscard]] const glm::uvec3& vertices(std::size_t triangle) const {
        return triangles_[triangle];
    }
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// A bound of the rounding of positions in single precision.
    [[nodiscard]] double rounding() const {
        const glm::dvec3 size = glm::dvec3(boxes_[1].high) - glm::dvec3(boxes_[1].low);
        return 1e-7 * std::max({size.x, size.y, size.z});
    }
    /// \param enough  a search ends at a triangle within this squared distance
    [[nodiscard]] NearestTriangle nearest(const glm::dvec3& p, std::uint32_t guess,
                                          SearchWork& work, double enough = 0.0) const;
    /// Adds prisms to the nodes that have thin triangles and are not too large, so that the time is
    /// linear. The results of searches do not change.
    void add_prisms();
    /// Divides long triangles into up to `more` additional slabs, and builds the hierarchy of
    /// these. The results of searches do not change.
    void divide(std::size_t more);

  private:
    /// Positions are in single precision, so boxes in single precision are exact.
    struct Box {
        glm::vec3 low{std::numeric_limits<float>::infinity()};
        glm::vec3 high{-std::numeric_limits<float>::infinity()};

        void add(const glm::vec3& p) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        [[nodiscard]] double squared_distance(const glm::dvec3& p) const {
            // Written for each axis, which compiles without branches.
            const auto away = [](double from, double to, double at) {
                return std::max(std::max(from - at, at - to), 0.0);
            };
            const double x = away(low.x, high.x, p.x);
            const double y = away(low.y, high.y, p.y);
            const double z = away(low.z, high.z, p.z);
            return x * x + y * y + z * z;
        }
    };

    /// An infinite prism with a rectangular cross-section, along the mean direction of long
    /// triangles.
    struct Prism {
        std::array<glm::dvec3, 2> across;  ///< Perpendicular to the prism and to each other.
        std::array<double, 2> low{std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::infinity()};
        std::array<double, 2> high{-std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity()};

        void add(const glm::dvec3& p) {
            for (std::size_t i = 0; i < 2; ++i) {
                const double at = glm::dot(across[i], p);
                low[i] = std::min(low[i], at);
                high[i] = std::max(high[i], at);
            }
        }
        /// Returns a lower bound of the squared distance, which considers the rounding of `across`.
        [[nodiscard]] double squared_distance(const glm::dvec3& p) const {
            double sum = 0.0;
            for (std::size_t i = 0; i < 2; ++i) {
                const double at = glm::dot(across[i], p);
                const double away = std::max({low[i] - at, at - high[i], 0.0});
                sum += away * away;
            }
            return sum * (1.0 - 1e-12);
        }
    };

    /// A part of a triangle.
    struct Slab {
        Box box;
        std::uint32_t triangle;
    };

    void gather_corners();
    void sort_along_curve();
    [[nodiscard]] double slab_length(std::size_t more) const;
    void add_slabs(std::uint32_t triangle, double length);
    void sort_slabs();
    void build();
    [[nodiscard]] Prism prism_of(std::size_t begin, std::size_t end) const;
    /// Returns a lower bound of the squared distance of a node, and the node. The prism is
    /// considered only if the box does not exceed `known`.
    [[nodiscard]] std::pair<double, std::size_t> entry(const glm::dvec3& p, std::size_t node,
                                                       double known) const {
        const double distance = boxes_[node].squared_distance(p);
        const std::uint32_t prism =
            prism_of_node_.empty() || distance > known ? no_prism : prism_of_node_[node];
        return {
            prism == no_prism ? distance : std::max(distance, prisms_[prism].squared_distance(p)),
            node};
    }
    /// The leaves hold the triangles, or the slabs if there are any.
    [[nodiscard]] std::size_t items() const { return slabs_.empty() ? size() : slabs_.size(); }
    [[nodiscard]] std::uint32_t triangle_of(std::size_t item) const {
        return slabs_.empty() ? static_cast<std::uint32_t>(item) : slabs_[item].triangle;
    }
    [[nodiscard]] Box box_of(std::size_t item) const {
        if (!slabs_.empty()) return slabs_[item].box;
        const auto& at = corners_[item];
        return {glm::min(glm::min(at[0], at[1]), at[2]), glm::max(glm::max(at[0], at[1]), at[2])};
    }

    static constexpr std::size_t leaf_size = 4;
    static constexpr std::uint32_t no_prism = std::numeric_limits<std::uint32_t>::max();
    const Mesh& mesh_;
    std::vector<glm::uvec3> triangles_;
    std::vector<std::array<glm::vec3, 3>> corners_;  ///< By triangle.
    std::vector<Slab> slabs_;
    std::size_t leaves_ = 1;  ///< A power of two.
    std::vector<Box> boxes_;  ///< Children of node i are 2i and 2i + 1; leaves begin at leaves_.
    std::vector<Prism> prisms_;
    std::vector<std::uint32_t> prism_of_node_;  ///< Empty if there is no prism.
};

}  // namespace relief::detail
