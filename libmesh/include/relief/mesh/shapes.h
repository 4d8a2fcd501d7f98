// SPDX-License-Identifier: Apache-2.0
/// \file
/// Simple shapes around the origin, with normals and texture coordinates. Object space,
/// right-handed, y up. Tests: tests/mesh/geometry/shapes_test.cpp.
#pragma once

#include "relief/mesh/mesh.h"

namespace relief {

/// The square from -1 to 1 in the xy plane, facing +z, of cells x cells cells; the image upright
/// on it. \throws InvalidInput unless there are 1 to 4096 cells
Mesh make_quad(int cells = 1);

/// The unit sphere by longitude and latitude: u eastwards from +z, v from the north pole (+y)
/// down, with a seam and two poles. Normals are the positions.
/// \throws InvalidInput unless slices are 3 to 4096 and stacks 2 to 4096
Mesh make_sphere(int slices = 64, int stacks = 32);

/// The cube from -1 to 1 with 24 vertices: every face has its own, with its own normal and the
/// whole image upright on it.
Mesh make_cube();

/// A torus about the y axis: its tube's centre runs at distance 1, u along it from +z eastwards, v
/// round the tube, from its inner side over the top. \throws InvalidInput unless tube_radius is
/// within (0, 1], and slices and sides are 3 to 4096
Mesh make_torus(float tube_radius = 0.4F, int slices = 96, int sides = 48);

/// A closed cylinder about the y axis, of radius 1, from y = -1 to 1: u eastwards from +z, v from
/// the upper rim down; the ends show the image upright, with +x to the right.
/// \throws InvalidInput unless slices are 3 to 4096
Mesh make_cylinder(int slices = 64);

}  // namespace relief
