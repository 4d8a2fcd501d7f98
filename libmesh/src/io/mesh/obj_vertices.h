// SPDX-License-Identifier: Apache-2.0
/// \file
/// From corners that name position, texture coordinate and normal separately to indexed vertices.
///
/// Values are the same when all their bits are, so that nothing is rounded or merged by distance;
/// vertices are numbered in order of first use, which depends on the corners alone.
/// Tests: tests/mesh/io/mesh/obj_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "io/mesh/obj_parser.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// One vertex for every combination of values among the corners, filled into `mesh`; attributes
/// that no corner has stay empty.
///
/// Every corner must have a texture coordinate if any has, and a normal if any has.
/// \return the vertex of every corner
std::vector<std::uint32_t> unify_vertices(const ObjStatements& statements, Mesh& mesh);

}  // namespace relief
