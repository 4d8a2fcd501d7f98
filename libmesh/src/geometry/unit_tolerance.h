// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far the length of a stored direction may be from 1, and a tangent from the plane of its
/// normal.
#pragma once

namespace relief {

/// What 8-bit storage, the coarsest in use, leaves (half a step of 1/127 in each of three
/// components), and no more.
constexpr double unit_tolerance = 0.007;

/// Of the cosine between a normal and its tangent: 8-bit storage leaves up to 0.014, so that more
/// than this is what somebody meant.
constexpr double leaning_tolerance = 0.02;

}  // namespace relief
