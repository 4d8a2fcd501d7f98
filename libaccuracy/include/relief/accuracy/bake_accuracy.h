// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the errors and times of bakes with several sample counts and formats on the user's own
/// meshes, without writing maps, and selects the fewest samples and bits within a limit.
/// Tests: tests/accuracy/bake_accuracy_test.cpp, tests/tools/relief_bake_accuracy_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {
namespace accuracy {

/// The number of samples per texel.
struct BakeSampling {
    int samples = 1;
    /// Adaptive sampling: BakeMapOptions::sample_angle in degrees.
    std::optional<double> sample_degrees{};
};

/// A sampling in one format, with its measured error on a part of the map.
struct MeasuredBake {
    BakeSampling sampling;
    NormalMapFormat format;
    ErrorStats error;           ///< Against the mean normal over the texel.
    ErrorStats quantization;    ///< The error of the format alone, which no sample reduces.
    ErrorStats sampling_error;  ///< The error of the samples alone, which no format reduces.
    ErrorStats center;          ///< The error against the normal at the texel's center.
    std::size_t rays = 0;
    double seconds = 0.0;            ///< The time of the bake and its encoding.
    bool is_pareto_optimal = false;  ///< By compare_bakes(): none is faster and more accurate.
};

/// Bakes once, encodes in each format in memory, and compares the results with the reference.
std::vector<MeasuredBake> measure_bake(const BakeReference& reference, const BakeSampling& sampling,
                                       std::span<const NormalMapFormat> formats);

/// Computes MeasuredBake::error for each texel: one float channel in degrees, NaN without a
/// reference. If the reference has only bands of the map, they are stacked.
Image bake_error_map(const BakeReference& reference, const BakeSampling& sampling,
                     const NormalMapFormat& format);

/// Returns 1, 4, 16 and 64 samples, and 16 adaptive samples with thresholds of 8, 2 and 0.5
/// degrees.
std::span<const BakeSampling> default_bake_samplings();

/// Returns variants of `format`: 8 bits, 8 bits with blue-noise dithering, 16 bits, and float.
std::vector<NormalMapFormat> default_map_formats(const NormalMapFormat& format);

/// The bakes that were measured, and the part of the map that they were measured on.
struct BakeComparison {
    std::vector<MeasuredBake> measured;
    std::size_t texels = 0;
    bool is_whole = true;
    int reference_samples = 0;
    std::size_t reference_rays = 0;
    std::optional<MeasuredBake> selected;  ///< By select_bake().
};

/// Measures all default samplings in all default formats, three times. The times are medians.
/// \throws InvalidInput if no measured texel has a normal from the high model
BakeComparison compare_bakes(const Baker& baker, const BakeMapOptions& map,
                             const NormalMapFormat& format);

/// The limit and the choices of select_bake().
struct BakeSearch {
    double max_degrees = 0.0;
    ErrorKind kind = default_error_kind;
    std::optional<BakeSampling> sampling;  ///< If absent: 1, 4, 16, 64 or 256 samples.
    NormalMapFormat format;                ///< All but the bits.
    std::vector<int> bits;                 ///< The permitted ones among 8, 16 and 32, ascending.
};

/// No sampling and format is within the limit.
struct NoBakeWithinLimit : InvalidInput {
    using InvalidInput::InvalidInput;

    MeasuredBake smallest;  ///< The one with the smallest error.
    /// The one within the limit with the fewest bits, which are not permitted.
    std::optional<MeasuredBake> other_bits;
    bool has_all_samples = false;  ///< Whether 256 samples were measured.
};

/// Selects the fewest samples and bits within a limit.
///
/// Samples increase from 1 to 256. For each count, all bits are measured, which costs no rays. The
/// first count with permitted bits within the limit is selected, with the fewest such bits. 256
/// samples are compared with a reference of 1024, on an eighth of the texels; if the map is too
/// large for that, the maximum is 64.
/// \return the measurements in permitted bits, in the order tried, up to the selected one
/// \throws NoBakeWithinLimit
/// \throws InvalidInput if no measured texel has a normal from the high model, or if 256 samples
///         are given for a map of more than 2048 texels along a side
BakeComparison select_bake(const Baker& baker, const BakeMapOptions& map, const BakeSearch& search);

}  // namespace accuracy
}  // namespace relief
