// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lists the inputs of a plan with reasons: vertex attributes, textures with their mip chains, and
/// the passes of a frame. It needs no OpenGL and decodes no image.
#pragma once

#include <string>
#include <vector>

#include "relief/shade/effects.h"

namespace relief {

/// One stream of vertices.
struct PlannedAttribute {
    std::string name;     ///< GLSL: "tangent_object".
    bool stored = false;  ///< Otherwise it is computed, or a constant.
    std::string reason;
};

/// One texture that a draw samples.
struct PlannedTexture {
    std::string sampler;     ///< GLSL: "normal_texture".
    std::string image;       ///< The name of its source; empty for relief's own.
    bool mip_chain = false;  ///< It has smaller levels for minification.
    std::string reason;
};

struct DrawInputs {
    std::vector<PlannedAttribute> attributes;
    std::vector<PlannedTexture> textures;
};

/// Returns the inputs of a draw's program: the attributes and samplers of planned_interface().
DrawInputs planned_inputs(const Scene& scene, const DrawPlan& draw);

/// A pass of a frame, with its reason.
struct PlannedPass {
    std::string name;
    std::string reason;
};
std::vector<PlannedPass> planned_passes(const FramePlan& plan);

}  // namespace relief
