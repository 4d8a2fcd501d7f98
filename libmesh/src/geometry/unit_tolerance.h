// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tolerances of stored directions: their length, and the angle between a tangent and its normal.
#pragma once

namespace relief {

/// The largest deviation from unit length by 8-bit storage, the coarsest in use: half a step of
/// 1/127 in each of three components.
constexpr double unit_tolerance = 0.007;

/// The largest cosine between a normal and its tangent that counts as rounding. 8-bit storage
/// causes up to 0.014; larger values are intentional.
constexpr double leaning_tolerance = 0.02;

}  // namespace relief
