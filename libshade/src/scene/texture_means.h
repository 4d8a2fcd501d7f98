// SPDX-License-Identifier: Apache-2.0
/// \file
/// The mean colour of an image. Colours are averaged in linear light, data as they are; every texel
/// counts alike, whether a triangle uses it or not, and alpha is ignored.
/// Tests: tests/shade/scene/texture_means_test.cpp.
#pragma once

#include <glm/glm.hpp>

#include "relief/mesh/image.h"

namespace relief {

/// \return red, green, blue (grey thrice); non-finite samples are left out, and an image without
///         finite samples means 1
glm::vec3 mean_color(const Image& image);

}  // namespace relief
