// SPDX-License-Identifier: Apache-2.0
/// \file
/// What weightings and arithmetics of vertex normals err and cost, on meshes of surfaces in closed
/// form. Tests: tests/accuracy/normals_experiments_test.cpp.
#pragma once

#include <vector>

#include "planned_experiment.h"

namespace relief {

/// Surfaces cut into triangles in several ways, each with how the error falls with finer cells; a
/// large mesh, for times and memory; and the fans of [Max 1999].
std::vector<Experiment> normals_experiments(const RunOptions& options);

/// The same before they are run. \param options  must outlive the plan
std::vector<PlannedExperiment> normals_plan(const RunOptions& options);

}  // namespace relief
