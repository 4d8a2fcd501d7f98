// SPDX-License-Identifier: Apache-2.0
/// \file
/// What tangents.h promises for any input, in one place for every test that holds it to that.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

/// What is wrong with the tangents of all corners; empty if nothing is.
///
/// Every tangent is finite, unit and perpendicular to its unit normal within 1e-6 (floats of unit
/// vectors resolve 6e-8), w is +1 or -1 and the same all over a triangle. A normal without
/// direction (zero, not finite) binds nothing.
std::string broken_tangents(const Mesh& mesh, const std::vector<glm::vec4>& tangents);

}  // namespace relief::test
