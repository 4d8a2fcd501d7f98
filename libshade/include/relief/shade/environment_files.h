// SPDX-License-Identifier: Apache-2.0
/// \file
/// Finds the images of environment maps in folders.
#pragma once

#include <filesystem>

#include "relief/shade/scene.h"

namespace relief {

/// Finds six images in a folder by the ends of their names: posx, negx, posy, negy, posz, negz.
/// \throws FileError naming the first missing face, or two files for one face
CubeFaces cube_faces_in(const std::filesystem::path& folder);

}  // namespace relief
