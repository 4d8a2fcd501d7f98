// SPDX-License-Identifier: Apache-2.0
/// \file
/// What samples, thresholds and bits of baked normal maps err and cost.
/// Tests: tests/accuracy/bake_experiments_test.cpp.
#pragma once

#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// A fixed number of rays for each texel, and more only where the first differ; each in 8 and 16
/// bits and in float.
std::vector<Experiment> bake_experiments(const RunOptions& options);

}  // namespace relief
