// SPDX-License-Identifier: Apache-2.0
/// \file
/// A vase turned on a lathe: closed, smooth, and textured without stretching.
/// Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include "relief/mesh/mesh.h"

namespace relief::sample {

/// The vase standing on the origin, y up, 1.4 units tall; texture coordinates repeat three times
/// round it. No normals: they follow from the surface.
Mesh vase();

}  // namespace relief::sample
