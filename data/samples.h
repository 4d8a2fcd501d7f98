// SPDX-License-Identifier: Apache-2.0
/// \file
/// The images and models of data/, computed from formulas. Models are in object space, y up, and
/// have texture coordinates, but no normals. Every run computes the same bits.
/// Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

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

/// A stone with four ammonites, 1.1 units wide, as a scan: closed, with 300,304 triangles and a
/// color for each vertex, and without texture coordinates.
Mesh fossil();

}  // namespace relief::sample

namespace relief::sample {

// Gradient noise [Perlin 2002] in two and three dimensions, and helpers of the samples. Random
// numbers are integer hashes, so that all machines and runs compute the same bits. Noise has values
// within about [-1, 1] and a mean of 0.

/// A hash of a lattice point and a seed.
std::uint32_t hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed);

/// The hash as a number in [0, 1).
double random(std::int32_t x, std::int32_t y, std::uint32_t seed);

/// 0 below `from`, 1 above `to`, and a smooth transition in between. If from > to, it is reversed.
double smooth_step(double from, double to, double x);

double mix(double a, double b, double t);
inline glm::dvec3 mixed(glm::dvec3 a, glm::dvec3 b, double t) {
    return a + (b - a) * t;
}

/// Noise over a plane that repeats after `period` lattice cells along both axes.
double tiling_noise(double x, double y, std::int32_t period, std::uint32_t seed);

/// A sum of octaves of tiling noise over the unit square, scaled to about [-1, 1]. The first octave
/// has `cells` lattice cells along each axis; each further one has twice the frequency and half the
/// amplitude.
double tiling_octaves(double x, double y, std::int32_t cells, int octaves, std::uint32_t seed);

/// Noise in space, and a sum of its octaves.
double noise(double x, double y, double z, std::uint32_t seed);
double octaves(double x, double y, double z, int count, std::uint32_t seed);

/// Rounds a coordinate to a multiple of 1/100000, so that seams meet exactly, and files are short
/// and the same on every machine. The result is never -0.
inline float rounded(double value) {
    return static_cast<float>(std::round(value * 1e5) / 1e5 + 0.0);
}

}  // namespace relief::sample
