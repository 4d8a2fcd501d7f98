// SPDX-License-Identifier: Apache-2.0
/// \file
/// Images of the surroundings as light that half floats can hold.
/// Tests: tests/shade/gl/cube_map_test.cpp.
#pragma once

#include "relief/mesh/image.h"
#include "relief/mesh/report.h"

namespace relief {

inline constexpr float largest_half = 65504.0F;

/// Linear float of any image, with nothing that would become infinite as half float. Alpha, where
/// there is one, is treated alike: nothing looks it up.
///
/// \param report  counts texels that are clamped to 65504, the largest half float, and those that
///                are not finite: infinity counts as 65504, minus infinity and NaN as 0
Image storable_radiance(const Image& image, Report& report);

}  // namespace relief
