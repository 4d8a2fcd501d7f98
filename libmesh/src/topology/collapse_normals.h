// SPDX-License-Identifier: Apache-2.0
/// \file
/// The normals of the input at each vertex, which the triangles of collapses must not leave.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "topology/edge_collapse_parts.h"

namespace relief::detail {

/// Returns the cross product of two edges of a triangle of the surface.
glm::dvec3 cross_of(const CollapseInput& input, const CollapseSurface& surface,
                    std::size_t triangle);

/// Tests normals of triangles against those of the input at their corners.
class CollapseNormals {
  public:
    /// The input and the surface must outlive this object.
    CollapseNormals(const CollapseInput& input, const CollapseSurface& surface);

    /// Adds the unit normal of a triangle before any collapse.
    void add_triangle(std::size_t triangle, const glm::dvec3& normal);

    /// Lists the normals at vertices where their mean is not enough. No triangle is added later.
    void finish();

    /// Returns whether a triangle with this cross product is near the input at each of its corners.
    [[nodiscard]] bool is_near(const glm::dvec3& cross, std::uint32_t a, std::uint32_t b,
                               std::uint32_t c) const {
        return has_normal_near(a, cross) && has_normal_near(b, cross) && has_normal_near(c, cross);
    }

  private:
    [[nodiscard]] bool has_normal_near(std::uint32_t vertex, const glm::dvec3& cross) const;
    [[nodiscard]] glm::dvec3 input_normal(std::size_t triangle) const;
    void list_normals(const std::vector<std::uint8_t>& is_sharp);

    const CollapseInput& input_;
    const CollapseSurface& surface_;
    std::vector<glm::vec3> mean_normals_;  ///< By vertex: the sum of the unit normals, or 0.
    // For sharp vertices; with a maximum angle of normals, for all; otherwise empty:
    std::vector<std::uint32_t> normal_begin_;  ///< By vertex: its first entry in normals_at_.
    std::vector<glm::vec3> normals_at_;        ///< The normals of the input at each vertex.
};

}  // namespace relief::detail
