// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far reading or preparing is, in the line at the bottom. Tests:
/// tests/tools/window/reload_window_test.cpp.
#pragma once

#include <string>

#include "relief/mesh/progress.h"

namespace relief::tools {

/// "Reading big.obj: parsing", and a bar of its share where one is known.
void draw_progress(const std::string& what, const Progress::State& progress);

}  // namespace relief::tools
