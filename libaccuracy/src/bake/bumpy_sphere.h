// SPDX-License-Identifier: Apache-2.0
/// \file
/// A sphere with bumps, of radius 1 + 0.02 sin(12 longitude) sin(12 polar angle): as a formula, as
/// a high mesh by longitude and latitude, and where lines meet either: what baked maps are held
/// against, by the experiments and by the tables of docs/bake.md. Independent of the baker.
/// Tests: tests/accuracy/bake_experiments_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/mesh.h"

namespace relief {

/// Where a line comes upon a surface, and which way that faces there.
struct SurfacePoint {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};  ///< Unit.
};

class BumpySphere {
  public:
    /// A mesh of 4 stacks^2 triangles, whose vertices and their normals are those of the formula.
    explicit BumpySphere(int stacks);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

    /// Where a line that runs nearly towards the centre meets the formula's surface.
    /// \param inward  unit
    [[nodiscard]] static SurfacePoint on_surface(const glm::dvec3& from, const glm::dvec3& inward);

    /// Where it meets the mesh, and the mesh's interpolated normal: triangles around the place that
    /// on_surface() finds are tried, in double.
    /// \throws std::logic_error where none of them is met
    [[nodiscard]] SurfacePoint on_mesh(const glm::dvec3& from, const glm::dvec3& inward) const;

  private:
    int stacks_;
    Mesh mesh_;
};

}  // namespace relief
