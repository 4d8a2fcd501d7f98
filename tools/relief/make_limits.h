// SPDX-License-Identifier: Apache-2.0
/// \file
/// Limits of what an asset may lose, and the search for the triangles, the size of maps and the
/// bits of normals that hold them. Tests: tests/make/make_limits_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/error_bound.h"
#include "common/summary.h"
#include "relief/mesh/enum_names.h"
#include "relief/shade/fidelity.h"

namespace relief::tools {

/// Limits above 0 of the loss as it is printed, with four digits after the point.
struct LossLimits {
    ErrorBound normals;          ///< Of the angle between normals.
    std::optional<double> flip;  ///< Of the mean FLIP with each light.

    [[nodiscard]] bool any() const { return normals.degrees || flip; }
};

enum class LossLimit { degrees, flip };

/// The quantity that grows in the next asset.
enum class Growth { triangles, size, bits };

}  // namespace relief::tools

namespace relief {

template <>
inline constexpr auto enum_names<tools::Growth> =
    std::to_array<EnumName<tools::Growth>>({{"triangles", tools::Growth::triangles},
                                            {"size", tools::Growth::size},
                                            {"bits", tools::Growth::bits}});

}  // namespace relief

namespace relief::tools {

/// The next step of the search.
struct GrowthStep {
    Growth growth = Growth::triangles;
    int factor = 2;  ///< 2 or 4: of the triangles, or of both sides of maps.

    friend bool operator==(const GrowthStep&, const GrowthStep&) = default;
};

/// The largest side of maps that the search tries.
inline constexpr int max_limit_size = 8192;
/// The number of assets that the search makes, with the first one.
inline constexpr std::size_t max_attempts = 6;

/// An asset of the search, and what it lost.
struct LimitAttempt {
    std::size_t triangles = 0;  ///< The target number.
    glm::ivec2 size{0};
    int bits = 8;          ///< Of the normal map.
    double degrees = 0.0;  ///< By the statistic of the limit.
    double flip = 0.0;
    double silhouettes = 0.0;  ///< In pixels.
    /// The limit that is exceeded most, by the ratio; absent: all limits hold.
    std::optional<LossLimit> exceeded;
    double ratio = 0.0;  ///< The largest ratio of a figure to its limit.
    /// The degrees with normals before they were coded, if that was measured.
    std::optional<double> baked_degrees;
    std::optional<GrowthStep> next;  ///< Absent in the last attempt.
};

/// \param size  of the maps
/// \param bits  of the normal map
LimitAttempt attempt_of(const shade::Fidelity& loss, const LossLimits& limits,
                        std::size_t triangles, const glm::ivec2& size, int bits);

/// Returns whether the codes of the normal map may be what exceeds the limit: they have 8 bits, and
/// the excess is not larger than their largest error, 0.4 degrees.
bool may_be_codes(const LimitAttempt& attempt, const LossLimits& limits);

/// Notes the degrees with normals before they were coded.
/// \param coded, baked  the asset with its codes, and before
void note_baked(LimitAttempt& attempt, const LossLimits& limits, const shade::NormalLoss& coded,
                const shade::NormalLoss& baked);

/// Returns what the next asset has more of.
///
/// If the limit would hold with the normals before they were coded, they get 16 bits. Otherwise,
/// wide silhouettes ask for triangles; if they are narrow, the maps get larger. If the last growth
/// of a kind lowered the ratio by less than 10 %, the other kind is chosen. The factor is 2, or 4
/// if 2 cannot suffice: twice the triangles at most halve an error, and maps of twice the size at
/// most quarter it.
/// \param attempts  at least one; the limits do not hold in the last one
/// \param max_triangles  those of the source
/// \return absent if nothing can grow, or after max_attempts
std::optional<GrowthStep> next_growth(const std::vector<LimitAttempt>& attempts,
                                      const LossLimits& limits, std::size_t max_triangles);

/// One line for each attempt.
std::vector<std::string> limit_lines(const LossLimits& limits,
                                     const std::vector<LimitAttempt>& attempts);
Json limits_json(const LossLimits& limits, const std::vector<LimitAttempt>& attempts);

/// The message of a search in which the limits do not hold.
std::string limits_error(const LossLimits& limits, const std::vector<LimitAttempt>& attempts);

}  // namespace relief::tools
