// SPDX-License-Identifier: Apache-2.0
// Gradient noise from integer hashes (see samples.h). It uses only +, -, * and /, so that the
// result does not depend on a mathematical library.
#include "samples.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relief::sample {
namespace {

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

/// The dot product of the gradient at a lattice point and the offset from it. The gradient is one
/// of the twelve edge directions of a cube, or one of eight directions in the plane.
double corner(std::uint32_t hashed, double x, double y, double z) {
    static constexpr std::array<std::array<double, 3>, 12> edges{{{1, 1, 0},
                                                                  {-1, 1, 0},
                                                                  {1, -1, 0},
                                                                  {-1, -1, 0},
                                                                  {1, 0, 1},
                                                                  {-1, 0, 1},
                                                                  {1, 0, -1},
                                                                  {-1, 0, -1},
                                                                  {0, 1, 1},
                                                                  {0, -1, 1},
                                                                  {0, 1, -1},
                                                                  {0, -1, -1}}};
    const auto& edge = edges[hashed % edges.size()];
    return edge[0] * x + edge[1] * y + edge[2] * z;
}

double corner(std::uint32_t hashed, double x, double y) {
    static constexpr double d = 0.70710678118654752;
    static constexpr std::array<std::array<double, 2>, 8> directions{
        {{1, 0}, {d, d}, {0, 1}, {-d, d}, {-1, 0}, {-d, -d}, {0, -1}, {d, -d}}};
    const auto& direction = directions[hashed % directions.size()];
    return direction[0] * x + direction[1] * y;
}

std::int32_t wrapped(std::int32_t place, std::int32_t period) {
    return (place % period + period) % period;
}

}  // namespace

std::uint32_t hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
    std::uint32_t h = seed * 0x9E3779B9U + 0x7F4A7C15U;
    for (const std::int32_t part : {x, y, z}) {
        h ^= static_cast<std::uint32_t>(part) * 0x85EBCA6BU;
        h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
        h = (h ^ (h >> 12)) * 0x297A2D39U;
        h ^= h >> 15;
    }
    return h;
}

double random(std::int32_t x, std::int32_t y, std::uint32_t seed) {
    return hash(x, y, 0, seed) / 4294967296.0;
}

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double mix(double a, double b, double t) {
    return a + (b - a) * t;
}

double tiling_noise(double x, double y, std::int32_t period, std::uint32_t seed) {
    const double floor_x = std::floor(x);
    const double floor_y = std::floor(y);
    const auto cell_x = static_cast<std::int32_t>(floor_x);
    const auto cell_y = static_cast<std::int32_t>(floor_y);
    const double fx = x - floor_x;
    const double fy = y - floor_y;
    const auto at = [&](std::int32_t dx, std::int32_t dy) {
        const std::uint32_t hashed =
            hash(wrapped(cell_x + dx, period), wrapped(cell_y + dy, period), 0, seed);
        return corner(hashed >> 8, fx - dx, fy - dy);
    };
    const double u = fade(fx);
    return 1.4 * mix(mix(at(0, 0), at(1, 0), u), mix(at(0, 1), at(1, 1), u), fade(fy));
}

double tiling_octaves(double x, double y, std::int32_t cells, int octaves, std::uint32_t seed) {
    double sum = 0.0;
    double strength = 1.0;
    double total = 0.0;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += strength *
               tiling_noise(x * cells, y * cells, cells, seed + static_cast<std::uint32_t>(octave));
        total += strength;
        strength *= 0.5;
        cells *= 2;
    }
    return 1.6 * sum / total;
}

double noise(double x, double y, double z, std::uint32_t seed) {
    const double floor_x = std::floor(x);
    const double floor_y = std::floor(y);
    const double floor_z = std::floor(z);
    const double fx = x - floor_x;
    const double fy = y - floor_y;
    const double fz = z - floor_z;
    const auto at = [&](std::int32_t dx, std::int32_t dy, std::int32_t dz) {
        const std::uint32_t hashed =
            hash(static_cast<std::int32_t>(floor_x) + dx, static_cast<std::int32_t>(floor_y) + dy,
                 static_cast<std::int32_t>(floor_z) + dz, seed);
        return corner(hashed >> 8, fx - dx, fy - dy, fz - dz);
    };
    const double u = fade(fx);
    const double v = fade(fy);
    const double front = mix(mix(at(0, 0, 0), at(1, 0, 0), u), mix(at(0, 1, 0), at(1, 1, 0), u), v);
    const double back = mix(mix(at(0, 0, 1), at(1, 0, 1), u), mix(at(0, 1, 1), at(1, 1, 1), u), v);
    return mix(front, back, fade(fz));
}

double octaves(double x, double y, double z, int count, std::uint32_t seed) {
    double sum = 0.0;
    double strength = 1.0;
    double total = 0.0;
    for (int octave = 0; octave < count; ++octave) {
        sum += strength * noise(x, y, z, seed + static_cast<std::uint32_t>(octave));
        total += strength;
        strength *= 0.5;
        x *= 2.0;
        y *= 2.0;
        z *= 2.0;
    }
    return 1.6 * sum / total;
}

}  // namespace relief::sample
