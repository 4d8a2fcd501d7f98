// SPDX-License-Identifier: Apache-2.0
/// \file
/// What choices of shading err and cost: where light is computed, which highlight, which Fresnel
/// factor, how surroundings are stored and blurred, what edges and small highlights are averaged
/// by. Tests: tests/accuracy/shading_experiments_test.cpp.
#pragma once

#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// Those of formulas run everywhere. Those of pictures are drawn by OpenGL; without it, they are
/// there, say so, and measure nothing.
std::vector<Experiment> shading_experiments(const RunOptions& options);

}  // namespace relief
