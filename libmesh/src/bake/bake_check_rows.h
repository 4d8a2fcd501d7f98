// SPDX-License-Identifier: Apache-2.0
/// \file
/// Some rows of a map held against the surface: each texel's error, and the stages that it comes
/// from. In the axes of the meshes, in degrees. Tests: tests/mesh/bake/bake_check_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "accuracy/angle_sum.h"
#include "relief/mesh/bake_check.h"

namespace relief {

/// Normals that a bake makes of some rows.
struct CastRows {
    std::vector<float> normals, heights;
    std::vector<TexelState> states;
    std::size_t rays = 0;

    [[nodiscard]] bool is_baked(std::size_t texel) const {
        return states[texel] == TexelState::baked;
    }
    [[nodiscard]] glm::dvec3 normal(std::size_t texel) const {
        return {normals[3 * texel], normals[3 * texel + 1], normals[3 * texel + 2]};
    }
};

/// Bakes rows [first, last).
CastRows cast_rows(const Baker& baker, BakeMapOptions map, int first, int last, Report& report);

/// The codes that normals become, decoded again.
std::vector<float> coded(const std::vector<float>& normals, int width,
                         const NormalMapFormat& format);

/// All that is known of some rows, from row `first` of the map on.
struct RowsToCheck {
    int first = 0;
    int width = 0;
    int height = 0;                       ///< Of the map.
    std::vector<CoveredTexel> owners;     ///< Of texel centres.
    std::span<const float> map;           ///< Decoded: three a texel.
    const CastRows* reference = nullptr;  ///< The truth: of many samples.
    const CastRows* centre = nullptr;     ///< Of one.
    const CastRows* made = nullptr;       ///< As the map was: may be `centre`.
    std::span<const float> remade;        ///< `made`, through codes.
};

/// Sums over texels.
struct CheckSums {
    AngleSum error, centre, remade;
    std::array<AngleSum, bake_stage_count> stages;
    std::array<double, bake_stage_count> squares{};  ///< Stage's vectors along the whole.
    std::size_t missed = 0, frameless = 0, torn = 0;
    double tangent_squares = 0.0, object_squares = 0.0;  ///< Of angles between codes and normals.
    std::vector<WorstTexel> worst;
    std::vector<KnownTexel> known;

    void add(const CheckSums& others);
};

/// \param step     every so many texels, along and across, one of those that are not torn is kept
///                 in CheckSums::known; 0: none
/// \param degrees  gets the errors, NaN where there is none
CheckSums check_rows(const Baker& baker, const RowsToCheck& rows, int step,
                     std::span<float> degrees);

}  // namespace relief
