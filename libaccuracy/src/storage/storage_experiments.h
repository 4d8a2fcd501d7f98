// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on storing directions in few bits. Tests: tests/accuracy/storage_test.cpp.
#pragma once

#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

std::vector<Experiment> storage_experiments(const RunOptions& options);

/// Whole tangent frames, as vertex buffers hold them: what decoding costs and errs.
Experiment frame_codes_experiment(const RunOptions& options);

}  // namespace relief
