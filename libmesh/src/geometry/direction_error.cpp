// SPDX-License-Identifier: Apache-2.0
// Angles by atan2 in double, and their sums, in degrees. Unlike angle_distribution(), which counts
// what is no angle apart, one NaN makes all three sums NaN: there is no place here to tell of it.
// Tests: tests/mesh/geometry/error_statistics_test.cpp.
#include "relief/mesh/error_stats.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/angle_sum.h"
#include "relief/mesh/report.h"

namespace relief {

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
    const double sine = glm::length(glm::cross(a, b));
    const double cosine = glm::dot(a, b);
    if (!std::isfinite(sine) || !std::isfinite(cosine) || (sine == 0.0 && cosine == 0.0))
        return std::numeric_limits<double>::quiet_NaN();
    return std::atan2(sine, cosine) * 180.0 / std::numbers::pi;
}

DirectionError direction_error(std::span<const glm::vec3> directions,
                               std::span<const glm::dvec3> reference,
                               std::span<const unsigned char> counts) {
    if (directions.size() != reference.size() ||
        (!counts.empty() && counts.size() != directions.size())) {
        throw InvalidInput(fmt::format("{} directions cannot be compared with {}",
                                       directions.size(), reference.size()));
    }
    AngleMoments angles;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        if (!counts.empty() && counts[i] == 0) continue;
        angles.add(degrees_between(glm::dvec3(directions[i]), reference[i]));
    }
    DirectionError error{angles.rms(), angles.mean(), angles.max(), angles.count()};
    if (std::isnan(error.mean)) error.max = error.mean;
    return error;
}

}  // namespace relief
