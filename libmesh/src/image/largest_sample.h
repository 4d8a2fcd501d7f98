// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a full sample of an image is stored as: the largest code, 1 in floats.
/// Tests: tests/mesh/image/image_channels_test.cpp, tests/mesh/image/heights/height_map_test.cpp.
#pragma once

#include <limits>
#include <type_traits>

namespace relief {

/// In double, so that dividing codes by it is no division of whole numbers.
template <typename Sample>
inline constexpr double largest_sample =
    std::is_floating_point_v<Sample> ? 1.0
                                     : static_cast<double>(std::numeric_limits<Sample>::max());

}  // namespace relief
