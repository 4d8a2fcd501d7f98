// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which shader files a set of effects chooses, and the program's source put together from them.
///
/// The one table of parts (shader_parts.h) says for every file when it is chosen, which step
/// it stands for, and what it takes from outside; planned_interface() (effects.h) is read from it.
/// Tests: tests/shade/effects/surface_program_test.cpp, tests/shade/render/programs_test.cpp.
#pragma once

#include "effects/shader_source.h"
#include "relief/shade/effects.h"

namespace relief {

struct SurfaceProgram {
    ShaderSource vertex;
    ShaderSource fragment;
};

/// \param features  canonical, or a canonical set with more effects on
/// \throws GpuError if a file is missing (an override folder may hold broken ones)
SurfaceProgram surface_program(const Features& features);

/// The files chosen for each step of a stage.
struct ChosenSteps {
    ShaderSteps vertex;
    ShaderSteps fragment;
};
ChosenSteps chosen_steps(const Features& features);

/// The files that code a picture's last line, with the scene's exposure and tone curve where this
/// coding has them: for passes that are no surface.
ShaderSteps output_steps(OutputCoding coding, const Scene& scene);

}  // namespace relief
