// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading .gltf and .glb files, with their buffers, fully checked.
/// Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <filesystem>

#include "io/gltf/gltf_contents.h"
#include "relief/mesh/report.h"

namespace relief {

/// See GltfDocument::read. Images are not touched, beyond looking whether they exist.
GltfContents read_gltf(const std::filesystem::path& file, Report& report);

}  // namespace relief
