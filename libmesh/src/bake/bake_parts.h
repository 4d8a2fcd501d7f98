// SPDX-License-Identifier: Apache-2.0
/// \file
/// The high meshes of a bake by who sees them: all of them by all of the low mesh, or part by part.
/// Whatever else is baked from a hit (bake/high_surface.h) or from rays of its own (occlusion) asks
/// for the part of the texel that it is for. Tests: tests/mesh/bake/baker_test.cpp.
#pragma once

#include <memory>
#include <vector>

#include "bake/high_surface.h"
#include "bake/low_surface.h"
#include "relief/mesh/bake.h"

namespace relief {

/// What the rays of some of the low mesh's triangles may meet, and how far they run.
struct SeenSurface {
    /// \param low    what sees it: how far the two are apart says how far rays run
    /// \param reach  how far rays from a cage run; 0 without one
    /// \param name   for messages
    /// \throws BakeMismatch
    SeenSurface(std::span<const Mesh> meshes, const Mesh& low, const BakeOptions& options,
                double reach, const std::string& name, Report& report);

    BakeFit fit;
    double extent;  ///< No point of the high meshes is further than this from one of the low mesh.
    HighSurface high;
    BakeDistances distances;
};

class BakeParts {
  public:
    /// One part: all is seen by all.
    BakeParts(std::span<const Mesh> high, const LowSurface& low, const BakeOptions& options,
              Report& report);

    /// \throws InvalidInput if a triangle of `low` is not in exactly one part
    BakeParts(std::span<const BakePart> parts, const LowSurface& low, const BakeOptions& options,
              Report& report);

    /// What a texel of that triangle of the low mesh sees.
    [[nodiscard]] const SeenSurface& seen_by(std::uint32_t triangle) const {
        return *surfaces_[part_of_triangle_.empty() ? 0 : part_of_triangle_[triangle]];
    }

    [[nodiscard]] BakeDistances largest_distances() const;
    /// Of the boxes around all parts.
    [[nodiscard]] BakeFit fit() const;
    /// Of curvature and positions.
    [[nodiscard]] LayerBounds bounds(const BakeLayers& layers) const;

  private:
    std::vector<std::unique_ptr<SeenSurface>> surfaces_;
    std::vector<std::uint32_t> part_of_triangle_;  ///< Empty where there is only one part.
};

}  // namespace relief
