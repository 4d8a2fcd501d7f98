// SPDX-License-Identifier: Apache-2.0
/// \file
/// Gradient noise [Perlin 2002] in two and three dimensions, from integer hashes alone: the same
/// bits on every machine and in every run. Values lie within about [-1, 1], around 0.
/// Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace relief::sample {

/// A well mixed number from a lattice point and a seed.
std::uint32_t hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed);

/// A fraction of [0, 1) from the same.
double random(std::int32_t x, std::int32_t y, std::uint32_t seed);

/// 0 below `from`, 1 above `to`, smooth in between; from > to turns it round.
double smooth_step(double from, double to, double x);

double mix(double a, double b, double t);
inline glm::dvec3 mixed(glm::dvec3 a, glm::dvec3 b, double t) {
    return a + (b - a) * t;
}

/// Noise over a plane that repeats after `period` lattice cells both ways.
double tiling_noise(double x, double y, std::int32_t period, std::uint32_t seed);

/// Octaves of tiling noise, each twice as fine and half as strong, from `cells` lattice cells over
/// the unit square that x and y run through; scaled to about [-1, 1].
double tiling_octaves(double x, double y, std::int32_t cells, int octaves, std::uint32_t seed);

/// Noise in space, and octaves of it.
double noise(double x, double y, double z, std::uint32_t seed);
double octaves(double x, double y, double z, int count, std::uint32_t seed);

}  // namespace relief::sample
