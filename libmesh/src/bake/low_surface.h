// SPDX-License-Identifier: Apache-2.0
/// \file
/// The low-poly mesh of a bake: positions and projection lines of texels. All values are in the
/// space and unit of the meshes, in double. Tests: tests/mesh/bake/bake_test.cpp, padding_test.cpp.
#pragma once

#include <optional>

#include "bake/projection.h"
#include "relief/mesh/bake.h"

namespace relief {

class LowSurface {
  public:
    /// \throws InvalidInput as bake_normals()
    LowSurface(const Mesh& low, const BakeOptions& options, Report& report);

    /// Returns the mesh with the frames that renderers of the map use.
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

    /// Returns the line along which a texel is projected onto the high meshes.
    /// \param sample  the texel index for findings
    [[nodiscard]] ProjectionLine line(const CoveredTexel& texel, const BakeDistances& distances,
                                      std::size_t sample, Report& report) const;

    /// Returns the position of a texel on the mesh.
    [[nodiscard]] glm::dvec3 position(const CoveredTexel& texel) const {
        return interpolated(mesh_.positions, texel);
    }

    /// Returns whether rays start on a cage.
    [[nodiscard]] bool has_cage() const { return !cage_.empty(); }
    /// Returns the largest distance of a cage vertex from its mesh vertex; 0 without a cage.
    [[nodiscard]] double cage_reach() const;

  private:
    [[nodiscard]] glm::dvec3 direction(const CoveredTexel& texel, std::size_t sample,
                                       Report& report) const;
    [[nodiscard]] glm::dvec3 interpolated(std::span<const glm::vec3> values,
                                          const CoveredTexel& texel) const;

    Mesh mesh_;
    std::vector<glm::vec3> directions_;  ///< By vertex; empty for face normals.
    std::vector<glm::vec3> cage_;        ///< Cage positions by corner.
    std::optional<double> cage_inside_;  ///< Ray length behind the surface.
};

/// Moves a sample to at least `distance` from every edge of its triangle. If the triangle is too
/// small, the sample moves to the incenter. Returns none if the sample is far enough inside
/// already, or if its triangle has no area or is not finite.
///
/// A texel that only touches a chart has its nearest point exactly on an edge. If the high mesh has
/// an open border there, rounding decides whether a ray through that point hits it. A point further
/// inside than the rounding errors has no such problem.
std::optional<CoveredTexel> moved_inside(const Mesh& mesh, const CoveredTexel& texel,
                                         double distance);

}  // namespace relief
