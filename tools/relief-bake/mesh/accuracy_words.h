// SPDX-License-Identifier: Apache-2.0
/// \file
/// Ways to bake, in words. Tests: tests/tools/relief_bake_accuracy_test.cpp.
#pragma once

#include <string>

#include "mesh/mesh_accuracy.h"

namespace relief::tools {

/// "4 samples, 16 bit", "auto samples at 2 degrees, 8 bit, dithered"
std::string method_words(const MeasuredBake& bake);

}  // namespace relief::tools
