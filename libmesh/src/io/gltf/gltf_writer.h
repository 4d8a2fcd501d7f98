// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writes the contents of glTF documents as files.
#pragma once

#include <filesystem>

#include "io/gltf/gltf_contents.h"

namespace relief::detail {

/// Writes a valid document by the extension of the file, see GltfDocument::write().
/// \throws FileError
void write_gltf(const std::filesystem::path& file, const GltfContents& contents);

}  // namespace relief::detail
