// SPDX-License-Identifier: Apache-2.0
/// \file
/// Gradient noise [Perlin 2002] in two and three dimensions, and helpers of the samples. Random
/// numbers are integer hashes, so that all machines and runs compute the same bits. Noise has
/// values within about [-1, 1] and a mean of 0. Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace relief::sample {

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
