// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writing .gltf and .glb files. Tests: tests/mesh/io/gltf/gltf_document_test.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/gltf/gltf_contents.h"

namespace relief {

/// See GltfDocument::write.
void write_gltf(const std::filesystem::path& file, const GltfContents& contents);

/// The media type of an encoded image by its first bytes: PNG, JPEG, WebP, AVIF, KTX2 or DDS; empty
/// for anything else.
std::string image_media_type(std::string_view bytes);

}  // namespace relief
