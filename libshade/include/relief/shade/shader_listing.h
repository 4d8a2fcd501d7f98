// SPDX-License-Identifier: Apache-2.0
/// \file
/// The programs that a plan draws with, as the driver gets them, to read. Pure: no OpenGL.
/// Tests: tests/shade/effects/shader_listing_test.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// One program, put together from the files in shaders/.
struct ShaderListing {
    Features features;
    std::vector<std::size_t> draws;  ///< Of the plan, by index: those that it draws.
    std::string vertex;              ///< GLSL.
    std::string fragment;
    std::vector<std::string> files;  ///< That both stages hold, sorted.
};

/// One entry for each program, in the order of the draws that need them first.
/// \throws GpuError if a file of $RELIEF_SHADER_DIR includes what does not exist
std::vector<ShaderListing> shader_listings(const FramePlan& plan);

}  // namespace relief
