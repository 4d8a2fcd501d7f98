// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on storing directions in few bits. Tests: tests/accuracy/frame_codes_test.cpp.
#pragma once

#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

std::vector<Experiment> storage_experiments(const RunOptions& options);

/// Whole tangent frames, as vertex buffers hold them: what they err, and what reading them takes.
Experiment frame_reading_experiment(const RunOptions& options);

/// The same, and what writing them takes.
Experiment frame_writing_experiment(const RunOptions& options);

}  // namespace relief
