// SPDX-License-Identifier: Apache-2.0
/// \file
/// Two models to shade: a pot for tea, and a knot of beads. Object space, y up, standing on
/// the xz plane; texture coordinates, no normals. Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include "relief/mesh/mesh.h"

namespace relief::sample {

/// A pot of about 1.6 x 1 units: belly, lid and knob turned on the lathe, a spout towards +x and a
/// handle towards -x that reach into the belly.
Mesh pot();

/// A trefoil knot of 1.7 units' width whose rope swells and thins thirty times: 12,800 triangles.
Mesh knot();

}  // namespace relief::sample
