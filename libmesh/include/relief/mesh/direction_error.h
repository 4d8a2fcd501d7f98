// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far directions are from the truth, in degrees. The one home of that measure.
/// Tests: tests/mesh/accuracy/direction_error_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>

namespace relief {

/// The angle between two directions of any length, in degrees, 0 to 180; by atan2 in double, which
/// resolves what arc cosines cannot. NaN if one is zero or not finite.
double degrees_between(const glm::dvec3& a, const glm::dvec3& b);

/// Of many directions, in degrees.
struct DirectionError {
    double rms = 0.0;  ///< Root of the mean square.
    double mean = 0.0;
    double max = 0.0;
    std::size_t count = 0;
};

/// \param counts  1 for each direction to look at, 0 for others; or empty for all
/// \return all zeros where there is none; NaN in all three where some direction is zero or not
///         finite: an error of no known size must not vanish in a mean
/// \throws InvalidInput if the spans are not equally long
DirectionError direction_error(std::span<const glm::vec3> directions,
                               std::span<const glm::dvec3> truth,
                               std::span<const unsigned char> counts = {});

}  // namespace relief
