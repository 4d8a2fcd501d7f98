// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads and checks .gltf and .glb files with their buffers.
#pragma once

#include <filesystem>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/report.h"

namespace relief {

/// See GltfDocument::read(). Images are not opened; only their existence is checked.
GltfContents read_gltf(const std::filesystem::path& file, Report& report);

}  // namespace relief
