// SPDX-License-Identifier: Apache-2.0
/// \file
/// The checks of a single model or image. Tests: tests/check/relief_check_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "check_item.h"
#include "check_walk.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/normal_map_check.h"

namespace relief::tools {

/// Reads and checks a model. A file that cannot be read is a finding; nothing is thrown.
CheckedItem check_model_file(const CheckInput& input);

/// The properties of an image file that do not depend on its use.
struct ImageFacts {
    std::filesystem::path file;
    bool are_normals = false;  ///< It was read and checked as a normal map in tangent space.
    bool is_unused = false;    ///< No use was known: its metadata and its name decided.
    std::string fault;         ///< Why it cannot be read; the others are then empty.
    ImageFigures figures;
    glm::ivec2 texels = {0, 0};
    std::map<std::string, std::string> metadata;
    std::optional<MapContent> content;          ///< Judged by texels; absent if stated.
    std::vector<MapConditionCount> conditions;  ///< Of normals.
};

/// Returns whether materials use an image as normals; nothing if none uses it.
std::optional<bool> are_used_as_normals(const std::vector<ImageRole>& roles);

/// Reads an image file. One that cannot be read has a fault; nothing is thrown.
/// \param as_normals  absent: its metadata and its name decide
/// \param judges_content  finds ImageFacts::content
ImageFacts measure_image_file(const std::filesystem::path& file, std::optional<bool> as_normals,
                              bool judges_content);

/// Checks an image for its uses.
/// \param facts  with the content, and measured for are_used_as_normals(roles)
CheckedItem judge_image(const ImageFacts& facts, const std::vector<ImageRole>& roles);

/// Reads and checks an image file.
/// \param roles  its uses by materials, sorted; without any, its name and metadata decide
CheckedItem check_image_file(const std::filesystem::path& file,
                             const std::vector<ImageRole>& roles);

/// Checks an image that is embedded in a document, and adds the findings to its item.
/// \param index  of the image in the document
ImageFigures check_embedded_image(const GltfImage& image, std::size_t index,
                                  const std::vector<ImageRole>& roles, CheckedItem& item);

/// Returns the extension of an encoded image; empty if it is neither PNG nor JPEG.
std::string_view image_suffix(std::span<const std::byte> bytes);

/// Returns the message of an error about a file without the name of the file.
std::string reason_of(const std::string& message, const std::filesystem::path& file);

}  // namespace relief::tools
