// SPDX-License-Identifier: Apache-2.0
/// \file
/// Triangles that are blended, in the order in which the eye wants them: farthest first.
///
/// Sorted by their centres along the line of sight, which is right wherever triangles neither
/// intersect nor overlap in a cycle. Tests: tests/shade/render/sorted_triangles_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief {

class SortedTriangles {
  public:
    /// Centres in object space; non-finite ones count as nearest.
    SortedTriangles(const Mesh& mesh, const MaterialRange& range);

    /// \param farther_object  the direction in object space in which things are farther away (any
    ///                       length but 0): the camera's own -z, by the transposed object matrix
    /// \return the triangles, farthest first; equally far ones in the mesh's order
    std::span<const glm::uvec3> sort(const glm::vec3& farther_object);

    /// The range's centre, by which draws are sorted among each other. Object space.
    [[nodiscard]] const glm::vec3& center() const { return center_; }

  private:
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::vec3> centers_;
    glm::vec3 center_{0.0F};
    std::vector<std::uint32_t> order_;
    std::vector<float> depths_;
    std::vector<glm::uvec3> sorted_;
};

}  // namespace relief
