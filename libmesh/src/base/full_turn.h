// SPDX-License-Identifier: Apache-2.0
/// \file
/// The angle of a full turn.
/// Tests: tests/mesh/accuracy/analytic_surfaces_test.cpp.
#pragma once

#include <numbers>

namespace relief {

inline constexpr double full_turn = 2.0 * std::numbers::pi;

}  // namespace relief
