// SPDX-License-Identifier: Apache-2.0
/// \file
/// Height fields in floats for tests.
#pragma once

#include <cstdint>
#include <functional>

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"

namespace relief::test {

inline constexpr Wrap all_wraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

/// One channel of floats, `at(column, row)` each.
Image heights_of(int width, int height, const std::function<double(int, int)>& at);

/// Noise from 0 to 1 without any symmetry, the same in every run.
Image rough(int width, int height, std::uint32_t seed = 12345);

}  // namespace relief::test
