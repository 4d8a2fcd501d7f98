// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tubes along curves and surfaces turned on a lathe. Object space; positions are rounded to
/// multiples of 1/100000, so that files are the same on every machine.
/// Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::sample {

/// A curve in space with a thickness, over t in [0, 1].
struct TubePath {
    std::function<glm::dvec3(double t)> center;
    std::function<double(double t)> radius;
    /// A direction that is nowhere along the curve; the tube's cross-section is laid out from it.
    std::function<glm::dvec3(double t)> reference;
    bool closed = false;  ///< t = 1 is t = 0 again.
};

/// Adds a tube of so many cells along and around. u runs around, v along, so many times.
void add_tube(Mesh& mesh, const TubePath& path, int along, int around, glm::dvec2 repeats);

/// A point of a cubic Bezier curve.
template <typename Vector>
Vector bezier(const Vector (&points)[4], double t) {
    const double s = 1.0 - t;
    return s * s * s * points[0] + 3.0 * s * s * t * points[1] + 3.0 * s * t * t * points[2] +
           t * t * t * points[3];
}

/// To a multiple of 1/100000; never -0.
glm::vec3 rounded(const glm::dvec3& position);

}  // namespace relief::sample
