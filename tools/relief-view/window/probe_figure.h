// SPDX-License-Identifier: Apache-2.0
/// \file
/// The figure of a probe over the picture: its vectors as arrows, the lobe of its highlight as a
/// surface, and its footprint in a texture. Positions on the picture are fractions of its width and
/// height, from the upper left.
/// Tests: tests/tools/window/probe_panel_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/shade/probe.h"
#include "relief/shade/scene.h"

namespace relief::tools {

struct ProbeArrow {
    std::string label;  ///< "n", "l1"
    glm::vec2 from{0.0F};
    glm::vec2 to{0.0F};
    glm::vec3 color_srgb{1.0F};
};

/// A triangle of the lobe.
struct ProbeFacet {
    std::array<glm::vec2, 3> corners{};
    float shade = 1.0F;  ///< Brightness, 0 to 1, by its direction to the eye.
};

struct ProbeFigure {
    std::vector<ProbeArrow> arrows;
    std::vector<ProbeFacet> lobe;  ///< Farthest first.
};

/// Returns the vectors of the first visible surface: n, v, t, b, and l, h and r of each light
/// before it, and the lobe of the first light with a highlight. Arrows of unit vectors are a fifth
/// of the picture's height long if they are parallel to it.
///
/// \param aspect  of the picture: width over height
/// \return empty if no surface is visible, or the point is not in front of the camera
ProbeFigure figure_of(const shade::Probe& probe, const shade::Camera& camera, double aspect);

/// The share of a highlight's peak that a surface sends in each direction.
class HighlightLobe {
  public:
    /// Takes light, model and exponent or roughness from a highlight's term.
    /// \return none if the term has no such values
    static std::optional<HighlightLobe> of(const shade::ProbeLayer& layer,
                                           const shade::ProbeTerm& term);

    /// \param direction_world  unit  \return from 0 to 1; 0 below the surface
    [[nodiscard]] double at(const glm::dvec3& direction_world) const;

    [[nodiscard]] const glm::dvec3& normal() const { return normal_; }

  private:
    enum class Kind { phong, blinn_phong, ggx };

    Kind kind_ = Kind::phong;
    double parameter_ = 1.0;  ///< The exponent, or alpha.
    glm::dvec3 normal_{0.0, 0.0, 1.0};
    glm::dvec3 light_{0.0, 0.0, 1.0};
};

/// Returns the outline of the pixel in the texture, as fractions of its width and height: the
/// ellipse with both ways to the next pixels as conjugate radii of half their length.
/// \return empty if the footprint is unknown
std::vector<glm::vec2> footprint_outline(const shade::ProbeLookup& lookup);

}  // namespace relief::tools
