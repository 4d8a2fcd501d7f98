// SPDX-License-Identifier: Apache-2.0
/// \file
/// What sweeps of normals have in common: the torus, the methods, and a measurement of each.
/// Tests: tests/accuracy/stability_experiments_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "normals/normal_methods.h"
#include "stability/sweep.h"

namespace relief {

inline constexpr const char* torus_truth_words =
    "the torus's own normals in closed form, which neither scale nor place change; tests "
    "differentiate the surface numerically as well";

AnalyticMesh swept_torus(const RunOptions& options);

/// relief's in both arithmetics, and plain code's.
std::vector<NormalMethod> swept_normal_methods();

std::vector<std::string> swept_names(const std::vector<NormalMethod>& methods);

/// \param normals  as many as truth, or more: the first are compared
std::vector<float> degrees_off(const std::vector<glm::vec3>& normals,
                               const std::vector<glm::dvec3>& truth);

/// A measurement of each method: errors of the sweeps, time on `mesh`.
void measure_swept_normals(const std::vector<NormalMethod>& methods, const Sweeps& sweeps,
                           const Mesh& mesh, const RunOptions& options, Experiment& experiment);

}  // namespace relief
