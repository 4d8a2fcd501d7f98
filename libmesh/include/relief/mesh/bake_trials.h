// SPDX-License-Identifier: Apache-2.0
/// \file
/// Measures the errors and times of bakes with several sample counts and formats, without writing
/// maps. Part of the library relief::bake.
/// Tests: tests/mesh/bake/bake_check_test.cpp, tests/accuracy/asset_maps_test.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relief/mesh/bake_check.h"
#include "relief/mesh/timing.h"

namespace relief {

/// The number of samples per texel.
struct BakeSampling {
    int samples = 1;
    /// Adaptive sampling: BakeMapOptions::sample_angle in degrees.
    std::optional<double> sample_degrees{};
};

/// The errors and times of one bake in several formats.
struct BakeMeasurement {
    std::vector<AngleSummary> errors;  ///< By format, against the mean normal over the texel.
    /// By format, the error of rounding to codes alone, which more samples do not reduce.
    std::vector<AngleSummary> quantization;
    AngleSummary sampling;             ///< The error of sampling alone, which no format reduces.
    std::vector<AngleSummary> center;  ///< By format, against the normal at the texel's center.
    std::size_t rays = 0;
    double cast_seconds = 0.0;         ///< The time of the bake without encoding.
    std::vector<double> code_seconds;  ///< The time of encoding, by format.
};

/// The reference for a map or some of its bands, with which any number of bakes can be compared.
///
/// Memory: 17 bytes per measured texel, and four times that during a measurement.
class BakeBenchmark {
  public:
    /// Computes the reference.
    ///
    /// \param texels  minimum number of texels to measure, in evenly spaced bands of 64 rows; all
    ///         if the map has fewer
    /// \param reference_samples  per texel of the reference; 0: 256, or the maximum for the size of
    ///         the map. Bakes of 256 samples need a reference of 1024; otherwise they are compared
    ///         with themselves
    BakeBenchmark(const Baker& baker, const BakeMapOptions& map, std::size_t texels,
                  int reference_samples = 0);
    ~BakeBenchmark();
    BakeBenchmark(const BakeBenchmark&) = delete;
    BakeBenchmark& operator=(const BakeBenchmark&) = delete;

    /// Bakes and encodes in memory, and compares the result as check_bake() does.
    [[nodiscard]] BakeMeasurement measure(const BakeSampling& way,
                                          std::span<const NormalMapFormat> formats) const;

    /// Computes BakeMeasurement::errors for each texel: one float channel in degrees, NaN without a
    /// reference. If only bands were measured, they are stacked.
    [[nodiscard]] Image error_map(const BakeSampling& way, const NormalMapFormat& format) const;

    [[nodiscard]] std::size_t texels() const;  ///< Number of measured texels, covered or not.
    [[nodiscard]] bool is_whole() const;
    [[nodiscard]] int reference_samples() const;
    [[nodiscard]] std::size_t reference_rays() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Returns 1, 4, 16 and 64 samples, and 16 adaptive samples with thresholds of 8, 2 and 0.5
/// degrees.
std::span<const BakeSampling> default_bake_samplings();

/// Returns variants of `format`: 8 bits, 8 bits with blue-noise dithering, 16 bits, and float.
std::vector<NormalMapFormat> default_map_formats(const NormalMapFormat& format);

struct TimedBakeMeasurement {
    BakeMeasurement trial;
    /// By format and round: the time of the bake and its encoding.
    std::vector<std::vector<double>> seconds;
};

/// Measures all ways, interleaved. \throws Cancelled between bakes if cancellation was requested
std::vector<TimedBakeMeasurement> measure_interleaved(const BakeBenchmark& trials,
                                                      std::span<const BakeSampling> ways,
                                                      std::span<const NormalMapFormat> formats,
                                                      const Repeats& repeats);

}  // namespace relief
