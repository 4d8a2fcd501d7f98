// SPDX-License-Identifier: Apache-2.0
/// \file
/// What ways of getting tangent frames err and cost, on textured surfaces in closed form.
/// Tests: tests/accuracy/tangents_experiments_test.cpp.
#pragma once

#include <vector>

#include "planned_experiment.h"

namespace relief {

/// Bases on surfaces cut and textured in several ways; on a large mesh, for times and memory; maps
/// baked in one basis and read in another; and frames stored and derived, drawn.
std::vector<Experiment> tangents_experiments(const RunOptions& options);

/// The same before they are run. \param options  must outlive the plan
std::vector<PlannedExperiment> tangents_plan(const RunOptions& options);

}  // namespace relief
