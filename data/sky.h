// SPDX-License-Identifier: Apache-2.0
/// \file
/// A late afternoon over rolling hills, as the six faces of a cube map.
/// Tests: tests/mesh/image/sample_data_test.cpp.
#pragma once

#include <array>

#include "relief/mesh/image.h"

namespace relief::sample {

/// The names of the faces in OpenGL's order.
inline constexpr std::array<const char*, 6> face_names{"posx", "negx", "posy",
                                                       "negy", "posz", "negz"};

/// One face in OpenGL's convention (seen from inside, s to the right, t down), 8 bits, sRGB; y is
/// up in the world.
Image sky_face(int face, int size);

}  // namespace relief::sample
