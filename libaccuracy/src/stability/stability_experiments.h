// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where methods break: meshes and images made ever smaller, larger, farther off and narrower,
/// heights ever steeper and higher, until the answer is wrong. Single hard inputs, each with its
/// promised outcome, are docs/hard-cases.md. Tests: tests/accuracy/stability_experiments_test.cpp.
#pragma once

#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// Normals by scale, by offset, and of needles; tangents by scale and by offset; height maps by
/// steepness and by offset. Beside relief's methods, what plain code does.
std::vector<Experiment> stability_experiments(const RunOptions& options);

}  // namespace relief
