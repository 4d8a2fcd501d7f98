// SPDX-License-Identifier: Apache-2.0
/// \file
/// How much of the surroundings places on the high meshes see: the share of rays about the normal,
/// by its cosine, that meet nothing. Tests: tests/mesh/bake/occlusion_test.cpp.
///
/// Directions are points of a (0,2)-sequence on the disc below the hemisphere, so that each place's
/// rays are spread evenly, and those of all samples of a texel together as well; their bits are
/// scrambled by a number made of the texel's place alone, so that neighbours do not err alike.
/// Source: [Kollig and Keller 2002].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/ray_scene.h"
#include "relief/mesh/bake_layers.h"
#include "relief/mesh/report.h"

namespace relief {

/// Where to look from.
struct OcclusionPlace {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0};    ///< Unit, about which rays run.
    glm::dvec3 face{0.0};      ///< Unit, of the triangle, to the side that is looked to.
    std::size_t texel = 0;     ///< Of the map.
    std::uint32_t sample = 0;  ///< Of the texel.
};

class Occlusion {
  public:
    /// \param samples  that share the rays of a texel
    Occlusion(const OcclusionOptions& options, std::uint32_t samples);

    [[nodiscard]] std::uint32_t rays_of_sample() const { return rays_; }

    /// \param report  counts places whose normal lies nearly along or behind their triangle: rays
    ///                run about the triangle's own
    /// \return for each place 0 (hidden) to 1 (open); rays below the triangle's plane do not count
    [[nodiscard]] std::vector<double> open_shares(const RayScene& scene,
                                                  std::span<const OcclusionPlace> places,
                                                  Report& report) const;

  private:
    std::optional<double> distance_;
    std::uint32_t rays_;
};

}  // namespace relief
