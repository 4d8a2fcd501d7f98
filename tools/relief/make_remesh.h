// SPDX-License-Identifier: Apache-2.0
/// \file
/// The decision whether a mesh is remeshed, as text and JSON. Tests: tests/make/remeshing_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/text.h"
#include "relief/make/remeshing.h"

namespace relief::tools {

/// "the surface is replaced by 120000 triangles: ..."
std::string remesh_text(const make::RemeshDecision& decision);

/// The text and a line for each criterion and for the distances.
std::vector<std::string> remesh_lines(const make::RemeshDecision& decision);

Json remesh_json(const make::RemeshDecision& decision);

}  // namespace relief::tools
