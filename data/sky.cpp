// SPDX-License-Identifier: Apache-2.0
// Radiance by direction in an invented landscape, y up: a clear sky that is paler at the horizon
// and brighter around the sun, two layers of clouds, three ranges of hills in haze, and a meadow.
// Linear light, mapped to display range by 1 - exp(-x). Each texel is the mean of four directions.
// Radiance depends only on the direction, so that faces meet without a seam.
// Tests: tests/mesh/image/sample_data_test.cpp.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "samples.h"

namespace relief::sample {
namespace {

const glm::dvec3 sun_direction = glm::normalize(glm::dvec3(-0.58, 0.36, -0.72));
constexpr glm::dvec3 sunlight(1.0, 0.74, 0.46);
constexpr glm::dvec3 haze(0.72, 0.66, 0.60);

/// Clear air: blue overhead, pale and warm below, brighter towards the sun.
glm::dvec3 air(glm::dvec3 direction) {
    const double up = std::max(direction.y, 0.0);
    const double towards_sun = std::max(glm::dot(direction, sun_direction), 0.0);
    const glm::dvec3 zenith(0.035, 0.115, 0.37);
    const glm::dvec3 middle(0.15, 0.33, 0.68);
    glm::dvec3 color = mixed(middle, zenith, std::sqrt(up));
    color = mixed(color,
                  mixed(glm::dvec3(0.74, 0.78, 0.84), sunlight * 1.25, towards_sun * towards_sun),
                  std::exp(-up * 5.5) * 0.92);
    color += sunlight * (0.55 * std::pow(towards_sun, 9.0) + 1.1 * std::pow(towards_sun, 90.0));
    color += sunlight * 60.0 * smooth_step(0.99935, 0.99985, towards_sun);
    return color;
}

/// Adds a layer of clouds over `color`. Noise is its thickness; the side towards the sun is lit.
glm::dvec3 with_clouds(glm::dvec3 color, glm::dvec3 direction, double altitude, double cover,
                       std::uint32_t seed) {
    if (direction.y < 0.015) return color;
    const glm::dvec2 place =
        glm::dvec2(direction.x, direction.z) * (altitude / (direction.y + 0.10));
    const auto thickness = [&](glm::dvec2 at) {
        const double bent = 0.35 * octaves(at.x, at.y, 3.0, 2, seed + 20);
        return octaves(at.x + bent, at.y - bent, 0.0, 6, seed) + cover;
    };
    const double here = thickness(place);
    const double density = smooth_step(0.02, 0.55, here) * smooth_step(0.015, 0.16, direction.y);
    if (density <= 0.0) return color;
    const glm::dvec2 to_sun = glm::normalize(glm::dvec2(sun_direction.x, sun_direction.z));
    const double shade = std::clamp(here - thickness(place + to_sun * 0.16), -0.5, 0.5);
    const double towards_sun = std::max(glm::dot(direction, sun_direction), 0.0);
    const glm::dvec3 lit =
        glm::dvec3(1.02, 0.95, 0.87) + sunlight * 0.9 * std::pow(towards_sun, 6.0);
    const glm::dvec3 dark = mixed(glm::dvec3(0.40, 0.44, 0.53), sunlight, 0.25 * towards_sun);
    const double light = std::clamp(0.62 + 1.1 * shade - 0.25 * density, 0.0, 1.0);
    return mixed(color, mixed(dark, lit, light), 0.92 * density);
}

/// The sine of the elevation of the top of a range of hills, by horizontal direction.
double ridge(glm::dvec3 direction, double base, double rise, double detail, std::uint32_t seed) {
    const glm::dvec2 around = glm::normalize(glm::dvec2(direction.x, direction.z));
    return base + rise * octaves(around.x * detail, around.y * detail, 0.5, 5, seed);
}

glm::dvec3 meadow(glm::dvec3 direction) {
    const double down = std::max(-direction.y, 1e-4);
    const glm::dvec2 place = glm::dvec2(direction.x, direction.z) / (down + 0.02);
    const double far = std::exp(-down * 7.0);
    const double patches = 0.5 + 0.5 * octaves(place.x * 0.7, place.y * 0.7, 9.0, 4, 700);
    const double blades = octaves(place.x * 7.0, place.y * 7.0, 5.0, 4, 710) * (1.0 - far);
    glm::dvec3 color = mixed(glm::dvec3(0.045, 0.070, 0.012), glm::dvec3(0.165, 0.125, 0.040),
                             smooth_step(0.25, 0.8, patches));
    color *= 1.0 + 0.45 * blades;
    const double towards_sun = std::max(glm::dot(direction, sun_direction), 0.0);
    color += sunlight * 0.05 * std::pow(towards_sun, 3.0);
    return mixed(color, haze * glm::dvec3(0.36, 0.36, 0.28), 0.7 * far);
}

glm::dvec3 radiance(glm::dvec3 direction) {
    constexpr double lowest_sky = -0.012;
    constexpr double highest_hill = 0.3;
    if (direction.y < lowest_sky) return meadow(direction);
    glm::dvec3 color = air(direction);
    color = with_clouds(color, direction, 1.5, -0.14, 500);
    color = with_clouds(color, direction, 0.75, -0.04, 530);
    if (direction.y > highest_hill) return color;
    const double towards_sun = std::max(glm::dot(direction, sun_direction), 0.0);
    const glm::dvec3 veil = mixed(haze, sunlight * 1.15, towards_sun * towards_sun);
    struct Range {
        double base, rise, detail, veiled;
        glm::dvec3 color;
    };
    const Range ranges[] = {
        {0.085, 0.105, 2.3, 0.58, {0.13, 0.19, 0.32}},
        {0.045, 0.055, 3.4, 0.30, {0.070, 0.110, 0.105}},
        {0.008, 0.030, 5.2, 0.10, {0.045, 0.065, 0.022}},
    };
    std::uint32_t seed = 600;
    for (const Range& range : ranges) {
        const double top = ridge(direction, range.base, range.rise, range.detail, seed);
        const double woods = 1.0 + 0.35 * octaves(direction.x * 30.0, direction.y * 90.0,
                                                  direction.z * 30.0, 3, seed + 20);
        const glm::dvec3 hill = mixed(range.color * woods, veil, range.veiled);
        color = mixed(color, hill, smooth_step(top + 0.0015, top - 0.0015, direction.y));
        seed += 30;
    }
    return mixed(color, meadow(direction), smooth_step(0.004, lowest_sky, direction.y));
}

/// The direction through a point of a face, s and t from -1 to 1.
glm::dvec3 face_direction(int face, double s, double t) {
    switch (face) {
        case 0:
            return {1.0, -t, -s};
        case 1:
            return {-1.0, -t, s};
        case 2:
            return {s, 1.0, t};
        case 3:
            return {s, -1.0, -t};
        case 4:
            return {s, -t, 1.0};
        default:
            return {-s, -t, -1.0};
    }
}

}  // namespace

Image sky_face(int face, int size) {
    constexpr double exposure = 1.5;
    Image linear = make_image(size, size, 3, 32, ColorSpace::linear);
    auto sample = linear.as<float>().begin();
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            glm::dvec3 sum(0.0);
            for (const glm::dvec2 at :
                 {glm::dvec2(0.25, 0.25), {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}) {
                const double s = 2.0 * (column + at.x) / size - 1.0;
                const double t = 2.0 * (row + at.y) / size - 1.0;
                const glm::dvec3 light = radiance(glm::normalize(face_direction(face, s, t)));
                sum += 1.0 - glm::exp(-exposure * light);
            }
            for (int channel = 0; channel < 3; ++channel)
                *sample++ = static_cast<float>(sum[channel] / 4.0);
        }
    }
    return to_srgb(linear, 8);
}

}  // namespace relief::sample
