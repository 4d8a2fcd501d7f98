// SPDX-License-Identifier: Apache-2.0
/// \file
/// What kernels and arithmetics err and cost that make normals out of heights, on maps with known
/// normals. Tests: tests/accuracy/bump_experiments_test.cpp.
#pragma once

#include <vector>

#include "planned_experiment.h"

namespace relief {

/// One wave in floats, 16 and 8 bits, with how errors fall with its length; fields as files have
/// them, with heat maps of one; and a large map, for times and memory.
std::vector<Experiment> bump_experiments(const RunOptions& options);

/// The same before they are run. \param options  must outlive the plan
std::vector<PlannedExperiment> bump_plan(const RunOptions& options);

}  // namespace relief
