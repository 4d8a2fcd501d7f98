// SPDX-License-Identifier: Apache-2.0
/// \file
/// The environment in a direction, blurred, and as it is shed on a surface, straight from its
/// images, in double. World space, linear light, times the environment's intensity. Images are laid
/// out as scene.h says; faces as in environment/cube_faces.h.
/// Tests: tests/shade/reference/environment_lookup_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "environment/irradiance_sh.h"
#include "reference/texels.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace relief::reference {

class EnvironmentLookup {
  public:
    /// \param report  as in environment/radiance.h
    /// \throws FileError if an image cannot be read; InvalidInput if images do not fit together
    EnvironmentLookup(const Environment& environment, Report& report);

    /// \param direction_world  of any length but 0
    [[nodiscard]] glm::dvec3 radiance(const glm::dvec3& direction_world) const;

    /// The same, for a trace.
    [[nodiscard]] glm::dvec3 looked_up(const glm::dvec3& direction_world, Trace& trace) const;

    /// What a surface mirrors of it whose microfacets have GGX's distribution, seen and facing
    /// along the direction: the mean over directions l, mirrored at normals h that are drawn from
    /// the distribution, weighted by n.l.
    /// \param roughness  0 is a mirror
    [[nodiscard]] glm::dvec3 blurred(const glm::dvec3& direction_world, double roughness,
                                     Trace& trace) const;

    /// Irradiance over pi on a surface of this normal, by spherical harmonics of order 2
    /// [Ramamoorthi and Hanrahan 2001]; 0 where their sum is negative.
    [[nodiscard]] glm::dvec3 diffuse(const glm::dvec3& normal_world) const;

  private:
    enum class Layout { faces, equirectangular, angular };

    [[nodiscard]] glm::dvec3 face_texel(std::size_t face, int x, int y) const;
    [[nodiscard]] glm::dvec3 face_radiance(const glm::dvec3& direction) const;
    [[nodiscard]] std::vector<Image> faces() const;
    [[nodiscard]] glm::dvec3 texel_mean(std::size_t face, int x, int y, int size) const;

    Layout layout_ = Layout::faces;
    double intensity_ = 1.0;
    std::vector<Texels> images_;  ///< Six, or one.
    IrradianceSh irradiance_{};   ///< With the intensity.
};

/// GGX's directional albedo: x multiplies f0, y is added (environment/environment_brdf.h).
glm::dvec2 directional_albedo(double n_dot_v, double roughness);

}  // namespace relief::reference
