// SPDX-License-Identifier: Apache-2.0
/// \file
/// The high meshes of a bake: rays into all of them, and what is known where one hits. Another
/// attribute to bake (colour, a texture, a normal map of its own) is another function of a hit
/// here. Tests: tests/mesh/bake/bake_test.cpp.
#pragma once

#include <vector>

#include "bake/ray_scene.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {

class HighSurface {
  public:
    /// The meshes must outlive this. Those without normals get averaged ones (frames.h).
    /// \throws InvalidInput if one is not valid
    HighSurface(std::span<const Mesh> meshes, Report& report);

    [[nodiscard]] const RayScene& scene() const { return scene_; }

    /// Unit, interpolated; where it has no direction, the triangle's own, and counted.
    [[nodiscard]] glm::dvec3 normal(const RayHit& hit, std::size_t sample, Report& found) const;

  private:
    std::vector<Mesh> made_;  ///< Those that had to be given normals.
    std::vector<const Mesh*> meshes_;
    RayScene scene_;
};

}  // namespace relief
