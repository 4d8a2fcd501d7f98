// SPDX-License-Identifier: Apache-2.0
/// \file
/// What maps of several sample counts and codes would be off, and take, without writing them.
/// In the library relief::bake. Tests: tests/mesh/bake/bake_trials_test.cpp,
/// tests/accuracy/own_bake_test.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "relief/mesh/bake_check.h"
#include "relief/mesh/timing.h"

namespace relief {

/// How many samples a texel gets.
struct BakeWay {
    int samples = 1;
    std::optional<double> sample_degrees{};  ///< All of them only where the first differ by more.
};

/// One bake, in several codes.
struct BakeTrial {
    std::vector<AngleSummary> errors;  ///< By format, from the mean over the texel.
    /// By format, of the codes alone: what no number of samples makes less.
    std::vector<AngleSummary> quantisation;
    AngleSummary sampling;             ///< Of the samples alone: what no format makes less.
    std::vector<AngleSummary> centre;  ///< By format, from the normal at the texel's centre.
    std::size_t rays = 0;
    double cast_seconds = 0.0;         ///< Of the bake itself.
    std::vector<double> code_seconds;  ///< By format, of its codes.
};

/// The truth for a map, or some bands of it, kept for any number of bakes to be held against.
///
/// Memory: 17 bytes a texel looked at, and four times that while one is measured.
class BakeTrials {
  public:
    /// \param reference_samples  of the truth; 0: 256, or as many as the map has room for. Bakes of
    ///                           256 samples need 1024, else they are compared with themselves
    /// \param texels  at least so many are looked at, or all: in bands of 64 rows, evenly spread
    BakeTrials(const Baker& baker, const BakeMapOptions& map, std::size_t texels,
               int reference_samples = 0);
    ~BakeTrials();
    BakeTrials(const BakeTrials&) = delete;
    BakeTrials& operator=(const BakeTrials&) = delete;

    /// Bakes in memory, and codes, and compares as check_bake() does.
    [[nodiscard]] BakeTrial measure(const BakeWay& way,
                                    std::span<const NormalMapFormat> formats) const;

    /// Where such a map is off: BakeTrial::errors texel by texel, in degrees, as one float channel;
    /// NaN where there is no truth. Of parts of a map, one below the other.
    [[nodiscard]] Image error_map(const BakeWay& way, const NormalMapFormat& format) const;

    [[nodiscard]] std::size_t texels() const;  ///< Looked at, covered or not.
    [[nodiscard]] bool is_whole() const;
    [[nodiscard]] int reference_samples() const;
    [[nodiscard]] std::size_t reference_rays() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// 1, 4, 16 and 64 samples; and up to 16, where the first differ by more than 8, 2 and 0.5 degrees.
std::span<const BakeWay> usual_bake_ways();

/// What maps are stored in: 8 bits, plain and dithered, 16 bits, and floats; else like `format`.
std::vector<NormalMapFormat> usual_map_formats(const NormalMapFormat& format);

struct TimedBakeTrial {
    BakeTrial trial;
    /// By format, in each round: of the bake and of its codes.
    std::vector<std::vector<double>> seconds;
};

/// Bakes in every way, in turns. \throws Cancelled where that is wished, between bakes
std::vector<TimedBakeTrial> measured_in_turns(const BakeTrials& trials,
                                              std::span<const BakeWay> ways,
                                              std::span<const NormalMapFormat> formats,
                                              const Repeats& repeats);

}  // namespace relief
