// SPDX-License-Identifier: Apache-2.0
/// \file
/// Frames that are stored against frames that shaders derive, drawn: the only place where the
/// latter take time. Tests: tests/accuracy/drawn_frames_experiment_test.cpp.
#pragma once

#include "drawn/drawn_methods.h"

namespace relief {

/// Without OpenGL it is there, says so, and measures nothing.
Experiment drawn_frames_experiment(const Drawing& drawing, const RunOptions& options);

}  // namespace relief
