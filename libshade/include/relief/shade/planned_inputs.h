// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a plan feeds to the GPU, each with its reason: vertex attributes, textures with their mip
/// chains, and the passes of a frame. Pure: no OpenGL, and no image is decoded.
/// Tests: tests/shade/render/planned_inputs_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// One stream of vertices.
struct PlannedAttribute {
    std::string name;     ///< GLSL: "tangent_object".
    bool stored = false;  ///< Else it is computed, or a constant where it cannot be.
    std::string reason;
};

/// One texture that a draw samples.
struct PlannedTexture {
    std::string sampler;     ///< GLSL: "normal_texture".
    std::string image;       ///< By its source's name; empty: relief's own.
    bool mip_chain = false;  ///< Averaged to smaller levels, for where texels are below pixels.
    std::string reason;
};

struct DrawInputs {
    std::vector<PlannedAttribute> attributes;
    std::vector<PlannedTexture> textures;
};

/// What the program of a draw takes: the attributes and samplers of planned_interface().
DrawInputs planned_inputs(const Scene& scene, const DrawPlan& draw);

/// What is drawn one after another, and why.
struct PlannedPass {
    std::string name;
    std::string reason;
};
std::vector<PlannedPass> planned_passes(const FramePlan& plan);

}  // namespace relief
