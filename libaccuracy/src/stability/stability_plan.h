// SPDX-License-Identifier: Apache-2.0
/// \file
/// The experiments on stability, one by one.
/// Tests: tests/accuracy/stability_experiments_test.cpp.
#pragma once

#include "relief/accuracy/experiment.h"

namespace relief {

Experiment normals_by_scale(const RunOptions& options);
Experiment normals_by_offset(const RunOptions& options);
Experiment normals_of_needles(const RunOptions& options);
Experiment normals_beside_hard_triangles(const RunOptions& options);
Experiment tangents_by_scale(const RunOptions& options);
Experiment tangents_by_offset(const RunOptions& options);
Experiment bump_by_steepness(const RunOptions& options);
Experiment bump_by_offset(const RunOptions& options);

}  // namespace relief
