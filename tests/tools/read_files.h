// SPDX-License-Identifier: Apache-2.0
/// \file
/// What tools have written, findings discarded.
#pragma once

#include <filesystem>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"

namespace relief::test {

inline GltfDocument read_document(const std::filesystem::path& file) {
    Report report;
    return GltfDocument::read(file, report);
}

inline Image picture_in(const std::filesystem::path& file) {
    return read_image(file, ImageUse::color);
}

}  // namespace relief::test
