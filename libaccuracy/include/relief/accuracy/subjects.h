// SPDX-License-Identifier: Apache-2.0
/// \file
/// The subjects of experiments and the words for them, as command lines and reports say them.
/// Tests: tests/accuracy/experiment_test.cpp.
#pragma once

#include <string_view>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// Those that there are experiments on, in the order of reports.
std::vector<Subject> subjects_with_experiments();

/// Whether some of its experiments draw, by OpenGL: those errors are the renderer's.
bool is_drawn(Subject subject);

/// "normals", "tangents", ...
std::string_view word_of(Subject subject);

/// \throws InvalidInput naming the words that there are
Subject subject_from(std::string_view word);

}  // namespace relief
