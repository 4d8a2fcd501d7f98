// SPDX-License-Identifier: Apache-2.0
/// \file
/// The textures of detailed models, decoded for a bake: normal maps that go on top of their
/// normals, and colours. Tests: tests/tools/relief_bake_mesh_looks_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/map_models.h"
#include "relief/mesh/high_detail.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {

/// --high-normal-map, --high-color: a file for all high models, or their own.
struct HighLookOptions {
    std::optional<std::filesystem::path> normal_map, color;  ///< Empty: none.
};

void add_high_normal_map_option(CLI::App& app, HighLookOptions& options);
void add_high_color_option(CLI::App& app, HighLookOptions& options);

/// Details of high meshes, with the images that they name.
class HighLooks {
  public:
    /// \param mesh   which keeps its place in memory; its ranges name the model's materials
    /// \param report  counts textures by coordinates that the mesh does not have
    /// \throws FileError if an image cannot be read
    void add(const std::filesystem::path& file, const Mesh& mesh, const MapLooks& looks,
             const HighLookOptions& options, bool with_colors, Report& report);

    [[nodiscard]] std::span<const HighDetail> details() const { return details_; }

    /// "1 normal map of the high models on top", ...; empty where there are none.
    [[nodiscard]] std::string words() const;

  private:
    const Image* image(const std::filesystem::path& model, const MapLooks& looks, std::size_t index,
                       ImageUse use);
    const Image* image(const std::filesystem::path& file, ImageUse use);
    SurfaceTexture texture(const std::filesystem::path& model, const MapLooks& looks,
                           const GltfTexture& texture, ImageUse use);

    std::vector<HighDetail> details_;
    SurfaceNormalMap normal_map(const SurfaceTexture& texture, float scale) const;

    std::map<std::string, Image> images_;  ///< By file, number and use.
    /// Text entries of the files that images are from.
    std::map<const Image*, std::map<std::string, std::string>> metadata_;
    std::size_t normal_maps_ = 0;
    std::size_t color_textures_ = 0;
};

}  // namespace relief::tools
