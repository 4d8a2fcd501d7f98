// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes angles between directions, and statistics of many angles, in degrees.
/// Tests: tests/mesh/geometry/error_statistics_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {

// Computes angles between directions in degrees, and their RMS, mean and maximum.

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

// Computes statistics of many angles in degrees: mean, RMS, percentiles and a histogram.

/// Statistics of angles in degrees, from 0 to 180; all are zero if there is no angle.
struct AngleDistribution {
    /// Upper limits of the histogram bins; each bin holds the angles above the previous limit.
    static constexpr std::array bounds = {0.01, 0.1, 1.0, 5.0, 45.0, 90.0, 180.0};

    std::size_t count = 0;      ///< Number of angles that are not NaN.
    std::size_t undefined = 0;  ///< Number of NaNs: one of two directions was zero or not finite.
    double rms = 0.0;           ///< Root mean square.
    double mean = 0.0;
    double median = 0.0;  ///< The smallest angle that half of all angles do not exceed.
    double p90 = 0.0;     ///< The same for 90% of all angles.
    double p99 = 0.0;     ///< The same for 99% of all angles.
    double max = 0.0;
    std::array<std::size_t, bounds.size()> histogram{};

    friend bool operator==(const AngleDistribution&, const AngleDistribution&) = default;
};

/// Statistics of angles that are too many to store; all are zero if there is no angle.
struct AngleSummary {
    std::size_t count = 0;
    double rms = 0.0;  ///< Root mean square.
    double mean = 0.0;
    double p99 = 0.0;  ///< 99% of all angles do not exceed it; too large by at most 1/64.
    double max = 0.0;
};

/// Computes the statistics of angles.
///
/// \param degrees  in any order; the order affects only the last bits of rms and mean. NaNs are
///         counted as undefined and otherwise ignored
AngleDistribution angle_distribution(std::vector<float> degrees);

}  // namespace relief
