// SPDX-License-Identifier: Apache-2.0
/// \file
/// Solves for heights frequency by frequency: what the squares of a slope kernel's responses make
/// of heights, undone. Tests: tests/mesh/image/integration/heights_from_normals_test.cpp.
#pragma once

#include <vector>

#include "image/integration/real_transform.h"
#include "relief/mesh/bump.h"

namespace relief {

class FrequencySolver {
  public:
    FrequencySolver(int width, int height, const GradientKernel& kernel, Wraps wrap,
                    glm::dvec2 texel);

    /// Whether `solve` is the exact inverse of "slopes, then their transpose": not at a clamped
    /// border, which it takes for a mirrored one, nor where a kernel leans at a mirrored one.
    [[nodiscard]] bool is_exact() const { return is_exact_; }

    /// In place: what a SlopeOperator's transpose gave becomes heights of mean 0.
    void solve(double* values) const;

  private:
    /// Squared responses along an axis, by frequency.
    struct Axis {
        RealTransform transform;
        std::vector<double> difference, smoothing, shortness;
        Axis(int count, const GradientKernel& kernel, Wrap wrap, double texel);
    };
    void transform_rows(double* values, bool forward) const;
    void solve_columns(double* values) const;

    Axis x_, y_;
    bool is_exact_;
};

}  // namespace relief
