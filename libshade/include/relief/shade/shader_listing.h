// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lists the shader source of the programs of a plan, as the driver gets it. Pure: no OpenGL.
/// Tests: tests/shade/effects/shader_source_test.cpp.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// One program, assembled from the files in shaders/.
struct ShaderListing {
    Features features;
    std::vector<std::size_t> draws;  ///< Indices of the draws that use it.
    std::string vertex;              ///< GLSL.
    std::string fragment;
    std::vector<std::string> files;  ///< Parts of both stages, such as "light.glsl#point"; sorted.
};

/// Returns one entry per program, in the order of the first draw that uses it.
/// \throws GpuError if a file of $RELIEF_SHADER_DIR includes a missing part
std::vector<ShaderListing> shader_listings(const FramePlan& plan);

}  // namespace relief
