// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on tangent frames: methods on textured analytic surfaces, on a large mesh, and mixed
/// bases; and stored against derived frames in rendered images.
#pragma once

#include <vector>

#include "experiment_driver.h"
#include "rendered_methods.h"

namespace relief {

/// Runs tangents_plan().
std::vector<Experiment> tangents_experiments(const RunOptions& options);

/// \param options  must outlive the plan
std::vector<PlannedExperiment> tangents_plan(const RunOptions& options);

/// Compares stored frames with frames that shaders derive, in rendered images; only there do
/// derived frames cost time. Without OpenGL, nothing is measured and the finding says so.
Experiment rendered_frames_experiment(const GlDevice& device, const RunOptions& options);

}  // namespace relief
