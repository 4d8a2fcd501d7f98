// SPDX-License-Identifier: Apache-2.0
/// \file
/// The six scenes of the frame benchmarks: a sphere of 99,856 triangles with materials from plain
/// to metallic-roughness.
#pragma once

#include <vector>

#include "relief/shade/scene.h"

namespace relief::bench {

struct TypicalScene {
    const char* name;
    const char* minimal;            ///< Folder below bench/shade/minimal.
    std::vector<const char*> uses;  ///< Switches of the branching shader that are on.
    Scene scene;
};

std::vector<TypicalScene> typical_scenes();

}  // namespace relief::bench
