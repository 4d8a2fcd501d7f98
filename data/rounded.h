// SPDX-License-Identifier: Apache-2.0
/// \file
/// Coordinates as the samples store them. Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include <cmath>

namespace relief::sample {

/// To a multiple of 1 / 100000, so that seams meet exactly and files stay short; never -0.
inline float rounded(double value) {
    return static_cast<float>(std::round(value * 1e5) / 1e5 + 0.0);
}

}  // namespace relief::sample
