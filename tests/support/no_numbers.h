// SPDX-License-Identifier: Apache-2.0
/// \file
/// Floats that are no numbers to reckon with.
#pragma once

#include <limits>

namespace relief::test {

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float infinite = std::numeric_limits<float>::infinity();

}  // namespace relief::test
