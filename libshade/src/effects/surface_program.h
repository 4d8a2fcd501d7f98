// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which shader files a set of effects chooses, and the program's source put together from them.
///
/// The one table of parts (surface_program.cpp) says for every file when it is chosen, which step
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

/// The files chosen for each step of both stages.
ShaderSteps chosen_steps(const Features& features);

/// The file that codes the picture's last line.
std::string_view output_file(OutputCoding coding);

}  // namespace relief
