// SPDX-License-Identifier: Apache-2.0
/// \file
/// Lists the subjects of experiments and their names on command lines and in reports.
/// Tests: tests/accuracy/experiment_test.cpp.
#pragma once

#include <string_view>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/export.h"

namespace RELIEF_API relief {

/// Returns the subjects that have experiments, in the order of reports.
std::vector<Subject> subjects_with_experiments();

/// Returns true if some of its experiments draw with OpenGL, so that their errors depend on the
/// renderer.
bool uses_opengl(Subject subject);

/// Returns the name: "normals", "tangents", ...
std::string_view name_of(Subject subject);

/// Returns the subject of this name. \throws InvalidInput listing the valid names
Subject subject_from(std::string_view word);

}  // namespace relief
