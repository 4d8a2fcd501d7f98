// SPDX-License-Identifier: Apache-2.0
/// \file
/// FLIP as the paper writes it: filters as squares of weights, in double, one pixel after the
/// other.
#pragma once

#include <vector>

#include "relief/mesh/image.h"

namespace relief::test {

/// The error of each pixel of two opaque 8-bit sRGB pictures with three channels.
std::vector<double> flip_brute_force(const Image& reference, const Image& test,
                                     double pixels_per_degree);

}  // namespace relief::test
