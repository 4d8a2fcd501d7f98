// SPDX-License-Identifier: Apache-2.0
/// \file
/// One pixel of the picture of the CPU reference.
#pragma once

#include "relief/shade/reference.h"
#include "shade/render/draw_support.h"

namespace relief::test {

/// The rounding of radiance and of the camera's field of view to float.
inline constexpr double storage_rounding = 2e-6;

/// Renders a scene with the reference and discards its findings.
inline Reference traced(const Scene& scene, int size) {
    Report report;
    return render_reference(scene, {size, size}, report);
}

/// Returns the radiance at a pixel. With facing_square() and 2 x 2 pixels, pixel (1, 0) shows the
/// point (1, 1, 0), where the eye is in the direction (-1, -1, 3) / sqrt(11). With an odd size, the
/// middle pixel shows the origin from the front.
inline glm::dvec3 radiance_at(const Scene& scene, int size, int x, int y) {
    return glm::dvec3(pixel(traced(scene, size).radiance, x, y));
}

}  // namespace relief::test
