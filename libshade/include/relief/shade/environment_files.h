// SPDX-License-Identifier: Apache-2.0
/// \file
/// Environments from folders. Tests: tests/shade/scene/environment_files_test.cpp.
#pragma once

#include <filesystem>

#include "relief/shade/scene.h"

namespace relief {

/// Six images in a folder, by the ends of their names: posx, negx, posy, negy, posz, negz.
/// \throws FileError naming the first that is missing, or two that claim one place
CubeFaces cube_faces_in(const std::filesystem::path& folder);

}  // namespace relief
