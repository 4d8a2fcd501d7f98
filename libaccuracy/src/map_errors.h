// SPDX-License-Identifier: Apache-2.0
/// \file
/// How far the normals of a map are from the truth, texel by texel.
/// Tests: tests/accuracy/map_errors_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/image.h"

namespace relief {

/// Degrees of every texel, as one float channel; NaN where either direction is none.
///
/// \param normals  three float channels, y up
/// \param truth    as many, row by row from the top
/// \throws InvalidInput if they are not equally many
Image angles_of(const Image& normals, std::span<const glm::dvec3> truth);

/// These in one row, those within `margin` texels of the border left out.
std::vector<float> inner_angles(const Image& normals, std::span<const glm::dvec3> truth,
                                int margin);

/// How these are distributed.
AngleDistribution map_errors(const Image& normals, std::span<const glm::dvec3> truth,
                             int margin = 0);

}  // namespace relief
