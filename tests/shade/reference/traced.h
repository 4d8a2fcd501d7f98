// SPDX-License-Identifier: Apache-2.0
/// \file
/// One pixel of the reference's picture.
#pragma once

#include "../render/draw_test.h"
#include "relief/shade/reference.h"

namespace relief::test {

/// Float storage of radiance, and of the camera's field of view.
inline constexpr double storage_rounding = 2e-6;

/// The reference of a scene, findings discarded.
inline Reference traced(const Scene& scene, int size) {
    Report report;
    return render_reference(scene, {size, size}, report);
}

/// Its radiance at a pixel. With draw_test.h's facing square and 2 x 2 pixels, pixel (1, 0) shows
/// the point (1, 1, 0), from where the eye is at (-1, -1, 3) / sqrt(11); of an odd size, the middle
/// pixel shows the origin, straight from the front.
inline glm::dvec3 radiance_at(const Scene& scene, int size, int x, int y) {
    return glm::dvec3(pixel(traced(scene, size).radiance, x, y));
}

}  // namespace relief::test
