// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on storing directions in few bits. Tests:
/// tests/accuracy/normal_codes_test.cpp, frame_codes_test.cpp.
#pragma once

#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

std::vector<Experiment> storage_experiments(const RunOptions& options);

/// Unit normals, as maps and vertex buffers hold them: what they err, and what reading them takes.
Experiment normal_reading_experiment(const RunOptions& options);

/// A smooth surface: what writing it takes, and what dither does for the mean of a patch.
Experiment normal_writing_experiment(const RunOptions& options);

/// Whole tangent frames, as vertex buffers hold them: what they err, and what reading them takes.
Experiment frame_reading_experiment(const RunOptions& options);

/// The same, and what writing them takes.
Experiment frame_writing_experiment(const RunOptions& options);

}  // namespace relief
