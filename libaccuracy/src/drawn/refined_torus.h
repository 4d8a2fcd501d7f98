// SPDX-License-Identifier: Apache-2.0
/// \file
/// A torus of few to many triangles, drawn in several ways: what experiments on it have in common.
/// Tests: tests/accuracy/shading_experiments_test.cpp, drawn_frames_experiment_test.cpp.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "relief/accuracy/experiment.h"
#include "relief/shade/scene.h"

namespace relief {

/// Slices around its circle, half as many around the tube; so many stand for the smooth one.
inline constexpr int smooth_torus_slices = 768;

std::size_t torus_triangles(int slices);

/// "flat, 576 triangles"
std::string name_on_torus(const std::string& way, int slices);

/// From where the smooth one fills the picture: coarse ones are a little smaller.
Camera torus_camera();

/// The error by triangles, a curve for each way. \throws std::out_of_range where one is missing
Chart torus_chart(const Experiment& experiment, std::span<const std::string> ways,
                  std::span<const int> slices);

}  // namespace relief
