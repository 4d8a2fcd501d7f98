// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/many_samples_test.cpp.
#include "drawn/many_samples.h"

#include "drawn/picture_error.h"
#include "relief/shade/reference.h"

namespace relief {

Image many_samples(const Scene& scene, int size, int rays_a_side) {
    Report report;
    const int side = size * rays_a_side;
    const Reference reference = render_reference(scene, {side, side, 0.0}, report);
    const Image shown = reference_picture(reference.radiance, scene, OutputCoding::clamped);
    return without_alpha(averaged(shown, rays_a_side));
}

}  // namespace relief
