// SPDX-License-Identifier: Apache-2.0
/// \file
/// The checks of a single model or image. Tests: tests/check/relief_check_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "check_item.h"
#include "check_walk.h"
#include "relief/mesh/gltf_document.h"

namespace relief::tools {

/// Reads and checks a model. A file that cannot be read is a finding; nothing is thrown.
CheckedItem check_model_file(const CheckInput& input);

/// Reads and checks an image file.
/// \param roles  its uses by materials, sorted; without any, its name and metadata decide
CheckedItem check_image_file(const std::filesystem::path& file,
                             const std::vector<ImageRole>& roles);

/// Checks an image that is embedded in a document, and adds the findings to its item.
/// \param place  "image 2"
ImageFigures check_embedded_image(const GltfImage& image, const std::string& place,
                                  const std::vector<ImageRole>& roles, CheckedItem& item);

/// Returns the message of an error about a file without the name of the file.
std::string reason_of(const std::string& message, const std::filesystem::path& file);

}  // namespace relief::tools
