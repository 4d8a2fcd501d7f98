// SPDX-License-Identifier: Apache-2.0
/// \file
/// Directions are compared by the angle between them, not by components.
#pragma once

#include <numbers>

#include "relief/mesh/statistics.h"

namespace relief::test {

inline constexpr float half_turn = std::numbers::pi_v<float>;

using relief::degrees_between;

}  // namespace relief::test
