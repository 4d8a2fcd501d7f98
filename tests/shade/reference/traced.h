// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pixels of the picture of the CPU reference.
///
/// The tests shade a facing square: at the origin, seen from the front (the middle pixel of 3 x 3),
/// and at (1, 1, 0), where the eye is in the direction (-1, -1, 3) / sqrt(11) (the upper right
/// pixel of 2 x 2).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "relief/shade/reference.h"
#include "shade/render/draw_support.h"

namespace relief::test {

/// The rounding of radiance and of the camera's field of view to float.
inline constexpr double storage_rounding = 2e-6;

/// Renders a scene with the reference and discards its findings.
inline shade::Reference traced(const shade::Scene& scene, int size) {
    Report report;
    return shade::render_reference(scene, {size, size}, report);
}

/// Returns the radiance at a pixel. With facing_square() and 2 x 2 pixels, pixel (1, 0) shows the
/// point (1, 1, 0), where the eye is in the direction (-1, -1, 3) / sqrt(11). With an odd size, the
/// middle pixel shows the origin from the front.
inline glm::dvec3 radiance_at(const shade::Scene& scene, int size, int x, int y) {
    return glm::dvec3(pixel(traced(scene, size).radiance, x, y));
}

inline glm::dvec3 in_the_middle(const shade::Scene& scene) {
    return radiance_at(scene, 3, 1, 1);
}

inline glm::dvec3 in_the_corner(const shade::Scene& scene) {
    return radiance_at(scene, 2, 1, 0);
}

inline void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], storage_rounding * std::max(expected[i], 1.0)) << i;
}

/// Returns an image of one value, linear.
inline Image linear_texel(const glm::vec4& color, int channels = 3) {
    return constant_image(color, channels, 32, ColorSpace::linear);
}

}  // namespace relief::test
