// SPDX-License-Identifier: Apache-2.0
/// \file
/// How the angles between many directions and those they should be are distributed, in degrees.
/// Tests: tests/mesh/accuracy/angle_distribution_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace relief {

/// Degrees, 0 to 180; all zeros where nothing was measured.
struct AngleDistribution {
    /// Upper ends of the bins below; each holds what is above the one before.
    static constexpr std::array bounds = {0.01, 0.1, 1.0, 5.0, 45.0, 90.0, 180.0};

    std::size_t count = 0;      ///< Angles that are numbers.
    std::size_t undefined = 0;  ///< NaN: one of two directions was zero or not finite.
    double rms = 0.0;           ///< Root of the mean square.
    double mean = 0.0;
    double median = 0.0;  ///< The smallest angle that half of all do not exceed.
    double p90 = 0.0;     ///< The same for 90 of 100,
    double p99 = 0.0;     ///< and 99 of 100.
    double max = 0.0;
    std::array<std::size_t, bounds.size()> histogram{};

    friend bool operator==(const AngleDistribution&, const AngleDistribution&) = default;
};

/// The same in short, where there are too many angles to keep them (libmesh/src/accuracy/
/// angle_sum.h); all zeros where there are none.
struct AngleSummary {
    std::size_t count = 0;
    double rms = 0.0;  ///< Root of the mean square.
    double mean = 0.0;
    double p99 = 0.0;  ///< 99 of 100 are no larger: to within 1 part in 64, upwards.
    double max = 0.0;
};

/// \param degrees  in any order, which but for the last bits of rms and mean does not matter; NaN
///                 where there is none, which is counted as undefined and left out
AngleDistribution angle_distribution(std::vector<float> degrees);

}  // namespace relief
