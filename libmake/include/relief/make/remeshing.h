// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decides whether an asset is made from the triangles of its source or from a closed surface
/// around them (remesh.h). Part of the library relief::make. Tests: tests/make/remeshing_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"

namespace RELIEF_API relief {
namespace make {

/// When the triangles of a source are replaced: if a RemeshCriterion is exceeded and the distances
/// permit it, always, or never.
enum class Remeshing { automatic, always, never };

}  // namespace make

template <>
inline constexpr auto enum_names<make::Remeshing> =
    std::to_array<EnumName<make::Remeshing>>({{"auto", make::Remeshing::automatic},
                                              {"always", make::Remeshing::always},
                                              {"never", make::Remeshing::never}});

namespace make {

/// A figure that speaks for remeshing above its limit. Both are shares, from 0 on.
struct RemeshCriterion {
    std::string name;
    double limit = 0.0;
    std::optional<double> value;  ///< Absent: it was not measured.

    [[nodiscard]] bool is_exceeded() const { return value && *value > limit; }
};

/// The distances between the source and the closed surface around it, at random samples.
struct RemeshDistance {
    /// The distances of those points of the source that are seen from outside.
    double rms_of_source = 0.0, max_of_source = 0.0;
    /// The distances of the points of the closed surface from the source.
    double rms_of_surface = 0.0, max_of_surface = 0.0;
    double hidden = 0.0;  ///< The share of the source's area that is not seen from outside.
};

/// The largest root mean square distance, and the largest distance, in cells, for which
/// Remeshing::automatic replaces triangles.
constexpr double max_remesh_rms = 0.5;
constexpr double max_remesh_distance = 4.0;
/// With AssetOptions::shell, both are larger by what solids grow by.
constexpr double remesh_shell = 0.75;

/// The result of a decision.
struct RemeshDecision {
    bool is_remeshed = false;
    std::string reason;                     ///< "no figure exceeds its limit"
    std::vector<RemeshCriterion> criteria;  ///< Empty with Remeshing::always.
    std::size_t triangles = 0;              ///< Of the closed surface; 0: it was not computed.
    double cell = 0.0;                      ///< The size of a cell of its grid.
    std::optional<RemeshDistance> distance;
};

}  // namespace make
}  // namespace relief
