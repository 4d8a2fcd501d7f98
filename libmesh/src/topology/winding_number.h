// SPDX-License-Identifier: Apache-2.0
/// \file
/// The generalized winding number of triangles around points, with far triangles taken together.
/// Tests: tests/mesh/topology/winding_number_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace relief::detail {

/// A triangle with its winding.
using WoundTriangle = std::array<glm::dvec3, 3>;

/// Returns the exact winding number: the sum of the signed solid angles of all triangles, divided
/// by 4 pi. 1 inside of a closed surface that is oriented outwards, 0 outside.
/// Source: [Jacobson et al. 2013], solid angles [Van Oosterom and Strackee 1983].
double exact_winding_number(std::span<const WoundTriangle> triangles, const glm::dvec3& point);

/// A tree of triangles. The triangles of a node that is far from a point count together, by the
/// first two terms of their Taylor series.
///
/// The result does not depend on the order of the triangles or of their corners.
/// Source: [Barill et al. 2018].
class WindingTree {
  public:
    /// \param triangles  with finite corners
    explicit WindingTree(std::vector<WoundTriangle> triangles);

    /// A node is far if the distance of its center exceeds this many of its radii. The error is
    /// below 0.05 for coarse sums and below 0.005 for fine ones, which take several times as long.
    static constexpr double coarse = 2.5;
    static constexpr double fine = 8.0;

    [[nodiscard]] double winding_number(const glm::dvec3& point, double far_radii = fine) const;

  private:
    struct Node {
        glm::dvec3 center{0.0};   ///< The mean of the triangles' centers, weighted by area.
        double radius = 0.0;      ///< The distance of the farthest corner from the center.
        glm::dvec3 normal{0.0};   ///< The sum of normals times areas.
        glm::dmat3 moment{0.0};   ///< The sum of (center offset) x (normal times area).
        std::uint32_t first = 0;  ///< Of its triangles.
        std::uint32_t count = 0;
        std::uint32_t children = 0;  ///< The first of two; 0: it is a leaf.
    };

    void build(std::uint32_t node, std::span<std::uint32_t> triangles, std::size_t offset);
    void sum(Node& node) const;

    std::vector<WoundTriangle> triangles_;  ///< In the order of the leaves.
    std::vector<WoundTriangle> sorted_;     ///< Only during the construction.
    std::vector<Node> nodes_;
};

}  // namespace relief::detail
