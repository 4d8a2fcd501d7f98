// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on decimation: the error of decimated analytic surfaces.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy::detail {

/// A point of a triangle.
struct TriangleSample {
    glm::dvec3 position;
    glm::dvec3 normal;  ///< Of the triangle; not unit.
};

/// Returns points of a mesh that are spread evenly over its area, without random numbers.
std::vector<TriangleSample> area_samples(const Mesh& mesh, std::size_t count);

/// The quantity that an error of a decimation measures.
enum class DecimationError {
    distance,  ///< From the exact surface.
    angle,     ///< Between a triangle and the exact surface at the nearest point, in degrees.
};

/// Returns the error of a mesh at area_samples().
/// \param seed  of the surface
ErrorStats surface_errors(const Mesh& mesh, AnalyticSurface surface, std::uint32_t seed,
                          DecimationError kind);

}  // namespace relief::accuracy::detail
