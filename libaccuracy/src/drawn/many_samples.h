// SPDX-License-Identifier: Apache-2.0
/// \file
/// Pictures as they should be: the reference shader in double, by many rays for each pixel.
/// Tests: tests/accuracy/many_samples_test.cpp.
#pragma once

#include "relief/mesh/image.h"
#include "relief/shade/scene.h"

namespace relief {

/// \param scene  with a camera and an opaque background; no tone mapping
/// \param size   of the picture, in pixels
/// \param rays_a_side  squared, the rays of a pixel, at the centres of as many squares of it
/// \return three float channels, linear light; each ray's is cut to what a screen can show, [0,1],
///         before they are averaged, as a renderer with as many samples does
Image many_samples(const Scene& scene, int size, int rays_a_side);

}  // namespace relief
