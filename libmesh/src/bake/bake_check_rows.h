// SPDX-License-Identifier: Apache-2.0
/// \file
/// Comparison of rows of a baked map with a reference bake of many samples: the error of each texel
/// in degrees, in the space of the meshes, and its causes. Tests:
/// tests/mesh/bake/bake_check_test.cpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/angle_sum.h"
#include "relief/mesh/bake_check.h"

namespace relief {

/// The bake of some rows.
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

/// Normals encoded as map codes and decoded again.
std::vector<float> coded(const std::vector<float>& normals, int width,
                         const NormalMapFormat& format);

/// Sums of errors over texels.
struct CheckSums {
    AngleSum error, center, rebaked;
    std::array<AngleSum, bake_stage_count> stages;
    /// The part of each stage in the squared error vector.
    std::array<double, bake_stage_count> squares{};
    std::size_t missed = 0, frameless = 0, discontinuous = 0;
    /// Squared angles between codes and normals, in tangent and in object space.
    double tangent_squares = 0.0, object_squares = 0.0;
    std::vector<WorstTexel> worst;
    std::vector<KnownTexel> known;

    void add(const CheckSums& other);
};

/// Returns the options of the reference bake of a map. \param samples  0: the default of
/// BakeCheckOptions
BakeMapOptions reference_of(const BakeMapOptions& map, int samples);

/// The bakes for a check of some rows.
struct BakeCasts {
    CastRows reference;               ///< Many samples.
    CastRows center;                  ///< One sample, at the center of each texel.
    std::optional<CastRows> several;  ///< The number of samples of the map, if not one.

    /// \param report  gets the findings of the bake with the options of the map
    BakeCasts(const Baker& baker, const BakeMapOptions& map, int reference_samples, int first,
              int last, Report& report);

    [[nodiscard]] const CastRows& made() const { return several ? *several : center; }
    [[nodiscard]] std::size_t rays() const {
        return reference.rays + center.rays + (several ? several->rays : 0);
    }
};

/// Compares rows with the reference, in parallel.
/// \param made     the bake with the options of the map, which may be one of `casts`
/// \param remade   `made`, encoded and decoded
/// \param shown    the map, decoded; empty: `remade`
/// \param first    the first row
/// \param step     the distance, along and across, of texels stored in CheckSums::known; 0: none
/// \param degrees  gets the errors, NaN if there is none
CheckSums compare_rows(const Baker& baker, const BakeMapOptions& map, const BakeCasts& casts,
                       const CastRows& made, std::span<const float> rebaked,
                       std::span<const float> shown, int first, int step, std::span<float> degrees);

}  // namespace relief
