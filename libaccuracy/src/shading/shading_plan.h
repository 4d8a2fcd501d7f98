// SPDX-License-Identifier: Apache-2.0
/// \file
/// The experiments on shading, one by one; see shading_experiments.h for what they have in common.
/// Tests: tests/accuracy/shading_experiments_test.cpp, fresnel_experiment_test.cpp,
/// unit_normal_experiment_test.cpp, surroundings_experiments_test.cpp.
#pragma once

#include "drawn/drawn_methods.h"

namespace relief {

// Of formulas: they need no OpenGL.
Experiment glass_experiment(const RunOptions& options);
Experiment metal_experiment(const RunOptions& options);
Experiment unit_normal_experiment(const RunOptions& options);

// Of pictures.
Experiment interpolation_experiment(const Drawing& drawing, const RunOptions& options);
Experiment highlight_experiment(const Drawing& drawing, const RunOptions& options);
Experiment reflection_experiment(const Drawing& drawing, const RunOptions& options);
Experiment glossy_experiment(const Drawing& drawing, const RunOptions& options);
Experiment specular_aliasing_experiment(const Drawing& drawing, const RunOptions& options);
Experiment edge_experiment(const Drawing& drawing, const RunOptions& options);

}  // namespace relief
