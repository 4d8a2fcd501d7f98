// SPDX-License-Identifier: Apache-2.0
/// \file
/// The results of `relief check` for a file: its findings and its figures, which the cache keeps.
/// Tests: tests/check/relief_check_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "check_rules.h"
#include "common/summary.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/material.h"
#include "relief/mesh/report.h"

namespace relief::tools {

enum class CheckedKind { model, image, folder };

/// A finding of a rule in a file.
struct CheckFinding {
    const CheckRule* rule = nullptr;
    CheckSeverity severity = CheckSeverity::note;
    std::string place;  ///< "mesh 'Body' primitive 0", "image 3"; empty for the whole file.
    std::string text;   ///< "2 x collapsed triangle (triangle 3, 17): has two corners ..."
    std::size_t count = 1;
    bool is_fixable = false;  ///< --fix can run the remedy on the file or the embedded image.
    std::optional<std::size_t> image = std::nullopt;  ///< Its index if it is embedded.
};

/// The use of an image by a material.
struct ImageRole {
    TextureSlot slot = TextureSlot::base_color;
    bool is_gltf = false;  ///< False: of an MTL file, or paired by name.
    std::string material;
    std::vector<std::string> materials;  ///< Of the model.

    auto operator<=>(const ImageRole&) const = default;
};

/// An image file of a model.
struct UsedImage {
    std::filesystem::path file;
    ImageRole role;
};

/// An image, for budgets.
struct ImageFigures {
    int width = 0;
    int height = 0;
    std::uint64_t bytes =
        0;  ///< On the GPU with mip levels, as 8-bit RGBA or as the file's blocks.
};

/// The triangles of a model that show the textures of a material, for budgets.
struct MaterialFigures {
    std::string name;
    double surface_area = 0.0;  ///< In square units of the scene.
    double texture_area = 0.0;  ///< In squares of the image.
    /// The image of the base color, or else of the normals: a file, or an index into
    /// ModelFigures::embedded.
    std::optional<std::filesystem::path> file;
    std::optional<std::size_t> embedded;
};

struct ModelFigures {
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    std::size_t materials = 0;
    std::vector<MaterialFigures> surfaces;
    std::vector<ImageFigures> embedded;
};

/// A checked file.
struct CheckedItem {
    std::filesystem::path file;
    CheckedKind kind = CheckedKind::model;
    bool is_unreadable = false;
    std::vector<CheckFinding> findings;
    ModelFigures model;
    ImageFigures image;
    std::vector<UsedImage> images;  ///< Of a model.
    /// All files that were read, as they were before.
    std::map<std::filesystem::path, FileStamp> inputs;
    bool is_from_cache = false;

    /// Adds a finding with the severity of its rule.
    void add(const CheckRule& rule, const std::string& place, const std::string& text,
             std::size_t count = 1);
};

/// Returns whether --fix can write a file of this format.
bool can_be_fixed(const std::filesystem::path& file);

/// Returns a rule that exists.
const CheckRule& rule_named(std::string_view id);

/// The content of the cache and of the parts of shards, without the inputs.
Json json_of(const CheckedItem& item);
/// \throws nlohmann::json::exception or std::out_of_range if the content is not that of json_of()
CheckedItem item_of(const Json& json);

Json json_of(const ImageFigures& image);
ImageFigures image_figures_of(const Json& json);
CheckedKind checked_kind_of(const Json& json);

}  // namespace relief::tools
