// SPDX-License-Identifier: Apache-2.0
/// \file
/// Height fields made whole before slopes are taken. Tests: tests/mesh/image/bump_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "relief/mesh/bump.h"
#include "relief/mesh/report.h"

namespace relief {

/// The heights of an image with every non-finite one replaced.
///
/// \param height  one float channel
/// \return empty where all heights are finite already (the common case takes no memory); else a
///         copy in which each non-finite height is the mean of the finite ones in the smallest
///         square around it that has any (beyond the border by `wrap`: the tiled plane, or
///         nothing), or 0 where no height of the image is finite
std::vector<float> filled_holes(const Image& height, const Wraps& wrap, Report& report);

}  // namespace relief
