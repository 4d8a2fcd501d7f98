// SPDX-License-Identifier: Apache-2.0
/// \file
/// Normals interpolated over a triangle, and ways to shade with them.
/// Tests: tests/accuracy/unit_normal_experiment_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "shading/formula_methods.h"

namespace relief {

/// Places all over a triangle whose three unit normals are equally far apart, around +z.
class NormalSamples {
  public:
    /// \param degrees  between any two of the corners' normals, above 0 and below 120
    /// \param side     of a square grid, of which the half that lies on the triangle counts
    NormalSamples(double degrees, int side);

    [[nodiscard]] std::size_t count() const { return interpolated_.size(); }
    /// Shorter than 1.
    [[nodiscard]] const std::vector<glm::vec3>& interpolated() const { return interpolated_; }

    [[nodiscard]] std::vector<double> true_radiances() const;
    [[nodiscard]] double brightest() const;

    static const glm::vec3& light();  ///< Unit.
    static const glm::vec3& half();   ///< Between that and the eye, unit.

  private:
    std::vector<glm::vec3> interpolated_;
};

/// The normal as it is; by one step of Newton's for the inverse root, from 1; by a square root in
/// float; all in double. \param samples  must outlive the methods
std::vector<FormulaMethod> unit_normal_methods(const NormalSamples& samples);

}  // namespace relief
