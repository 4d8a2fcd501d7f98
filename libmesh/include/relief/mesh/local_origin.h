// SPDX-License-Identifier: Apache-2.0
/// \file
/// Chooses the origin relative to which floats hold the positions of a mesh with their digits.
/// Tests: tests/mesh/io/mesh/mesh_file_test.cpp, tests/python/test_arrays.py.
#pragma once

#include <glm/glm.hpp>

#include "relief/export.h"

namespace RELIEF_API relief {

/// Returns the origin for positions within a box.
///
/// \param low  the smallest finite coordinates, in double precision and any space
/// \param high  the largest finite coordinates; at least `low`
/// \return (0, 0, 0) if no coordinate is above 16 times the largest side of the box; else the
/// middle
///         of the box, rounded to a multiple of the power of two that is not less than this side;
///         `low` if the box is a point
glm::dvec3 local_origin(const glm::dvec3& low, const glm::dvec3& high);

}  // namespace relief
