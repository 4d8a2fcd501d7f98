// SPDX-License-Identifier: Apache-2.0
/// \file
/// The low mesh of a bake: where a texel is on it, along which line its ray runs, and what a normal
/// is in its tangent space. Space and unit of the meshes; in double.
/// Tests: tests/mesh/bake/bake_test.cpp.
#pragma once

#include "bake/projection.h"
#include "bake/texel_frame.h"
#include "relief/mesh/bake.h"

namespace relief {

class LowSurface {
  public:
    /// \throws InvalidInput as bake_normals()
    LowSurface(const Mesh& low, const BakeOptions& options, Report& report);

    /// The mesh with the frames that the map will be seen with.
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

    /// \param sample  for what is found out about a line, the index that it is counted by
    [[nodiscard]] ProjectionLine line(const CoveredTexel& texel, const BakeDistances& distances,
                                      std::size_t sample, Report& found) const;

    /// Where a texel is.
    [[nodiscard]] glm::dvec3 position(const CoveredTexel& texel) const {
        return interpolated(mesh_.positions, texel);
    }

    /// Whether rays run from a cage.
    [[nodiscard]] bool has_cage() const { return !cage_.empty(); }
    /// How far the cage is from the mesh at most; 0 without one.
    [[nodiscard]] double cage_reach() const;

  private:
    [[nodiscard]] glm::dvec3 direction(const CoveredTexel& texel, std::size_t sample,
                                       Report& found) const;
    [[nodiscard]] glm::dvec3 interpolated(std::span<const glm::vec3> values,
                                          const CoveredTexel& texel) const;

    Mesh mesh_;
    std::vector<glm::vec3> directions_;  ///< By vertex; none: of faces.
    std::vector<glm::vec3> cage_;        ///< Its places, by corner.
    std::optional<double> cage_inside_;  ///< How far rays go on behind the surface.
};

}  // namespace relief
