// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes angles between directions in degrees, and their RMS, mean and maximum.
/// Tests: tests/mesh/accuracy/error_statistics_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>

namespace relief {

/// Returns the angle between two directions of any length, in degrees, 0 to 180. It is computed by
/// atan2 in double precision, which is accurate for small angles, unlike the arc cosine. NaN if one
/// direction is zero or not finite.
double degrees_between(const glm::dvec3& a, const glm::dvec3& b);

/// Statistics of angles in degrees.
struct DirectionError {
    double rms = 0.0;  ///< Root mean square.
    double mean = 0.0;
    double max = 0.0;
    std::size_t count = 0;
};

/// Computes the statistics of the angles between corresponding directions.
///
/// \param truth  the exact directions, of any length
/// \param counts  1 for each direction to include, 0 for the others; or empty to include all
/// \return all zeros without directions; NaN for rms, mean and max if a direction is zero or not
///         finite, so that the error is not hidden in a mean
/// \throws InvalidInput if the spans differ in length
DirectionError direction_error(std::span<const glm::vec3> directions,
                               std::span<const glm::dvec3> reference,
                               std::span<const unsigned char> counts = {});

}  // namespace relief
