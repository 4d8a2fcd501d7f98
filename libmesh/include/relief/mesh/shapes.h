// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generates simple shapes around the origin with normals and texture coordinates. Object space,
/// right-handed, y up.
/// Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include "relief/mesh/mesh.h"

namespace relief {

/// Creates the square from -1 to 1 in the xy plane, facing +z, with cells x cells cells; the image
/// is upright. \throws InvalidInput unless there are 1 to 4096 cells
Mesh make_quad(int cells = 1);

/// Creates the unit sphere by longitude and latitude: u runs eastwards from +z, v down from the
/// north pole (+y), with a seam and two poles. Normals equal positions.
/// \throws InvalidInput unless slices are 3 to 4096 and stacks 2 to 4096
Mesh make_sphere(int slices = 64, int stacks = 32);

/// Creates the cube from -1 to 1 with 24 vertices: every face has its own four, with its normal and
/// the whole image upright.
Mesh make_cube();

/// Creates a torus about the y axis whose tube is centered at distance 1: u runs along the tube
/// eastwards from +z, v around the tube from its inner side over the top. \throws InvalidInput
/// unless tube_radius is within (0, 1], and slices and sides are 3 to 4096
Mesh make_torus(float tube_radius = 0.4F, int slices = 96, int sides = 48);

/// Creates a closed cylinder about the y axis with radius 1, from y = -1 to 1: u runs eastwards
/// from +z, v down from the upper rim. The caps show the image upright, with +x to the right.
/// \throws InvalidInput unless slices are 3 to 4096
Mesh make_cylinder(int slices = 64);

}  // namespace relief
