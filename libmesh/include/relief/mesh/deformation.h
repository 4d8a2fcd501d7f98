// SPDX-License-Identifier: Apache-2.0
/// \file
/// How vertices move with joints and morph targets, for decimation.
/// Tests: tests/mesh/io/gltf/gltf_deformation_test.cpp, tests/mesh/topology/decimate_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {

/// How the vertices of a mesh move with joints and morph targets, in a few numbers.
///
/// Each array is empty or has the length of `positions`. The numbers are linear in the weights of
/// joints and in the displacements. If there are more joints or targets than numbers, they are
/// projections, whose squared differences between vertices are about those of the weights and of
/// the displacements.
struct Deformation {
    std::vector<glm::vec4> joints;
    /// Object space.
    std::array<std::vector<glm::vec3>, 3> displacements;
};

}  // namespace relief
