// SPDX-License-Identifier: Apache-2.0
/// \file
/// The images and models of data/, computed from formulas. Models are in object space, y up, and
/// have texture coordinates, but no normals. Every run computes the same bits.
/// Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include <array>

#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"

namespace relief::sample {

// Images.

/// The heights of a wall of weathered bricks in running bond, which tiles: 16 bits, data. White is
/// the front of the foremost brick.
Image brick_heights(int size);

/// The diffuse color of the same wall: 8 bits, sRGB.
Image brick_colors(int size);

/// The names of the faces in OpenGL's order.
inline constexpr std::array<const char*, 6> face_names{"posx", "negx", "posy",
                                                       "negy", "posz", "negz"};

/// A face of a cube map, 8 bits, sRGB, in OpenGL's convention (seen from inside, s to the right, t
/// down): a late afternoon over rolling hills. y is up in the world.
Image sky_face(int face, int size);

// Models.

/// A vase on the origin, 1.4 units tall: closed, smooth, and textured without stretching. The
/// texture coordinates repeat three times around it.
Mesh vase();

/// A teapot of about 1.6 x 1 units on the xz plane. Belly, lid and knob are surfaces of revolution.
/// A spout towards +x and a handle towards -x intersect the belly.
Mesh pot();

/// A trefoil knot, 1.7 units wide, on the xz plane. The radius of its tube varies with 30 periods.
/// It has 12,800 triangles.
Mesh knot();

/// The detailed mesh of a pair for baking: an urn on the origin, 1 unit tall, closed, and carved
/// all over. It has no texture coordinates.
Mesh carved_urn();

/// The simple mesh of the pair: the same shape in few triangles. The texture coordinates never
/// overlap: the body is one chart, and the discs at bottom and top are two more.
Mesh plain_urn();

}  // namespace relief::sample
