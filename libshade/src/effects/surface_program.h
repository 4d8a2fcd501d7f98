// SPDX-License-Identifier: Apache-2.0
/// \file
/// The shader parts that a set of effects chooses, and the source of its program.
///
/// One table (surface_program.cpp) has a row for every step: the parts that implement it, the
/// condition of each, what it takes from outside, and the neutral code for a step whose effect is
/// absent. planned_interface() (effects.h) is read from the same table. Pure. Tests:
/// tests/shade/effects/shader_source_test.cpp, tests/shade/render/render_cache_test.cpp.
#pragma once

#include "effects/shader_source.h"
#include "relief/shade/effects.h"

namespace relief {

struct SurfaceProgram {
    ShaderSource vertex;
    ShaderSource fragment;
};

/// \param features  canonical, or a canonical set with more effects on
/// \throws GpuError if a part is missing (an override folder may hold broken files)
SurfaceProgram surface_program(const Features& features);

/// The code of each step of a stage.
struct ChosenSteps {
    ShaderSteps vertex;
    ShaderSteps fragment;
};
ChosenSteps chosen_steps(const Features& features);

/// The steps that code a picture, with the scene's exposure and tone curve if this coding has them:
/// for passes that draw no surface.
ShaderSteps output_steps(OutputCoding coding, const Scene& scene);

}  // namespace relief
