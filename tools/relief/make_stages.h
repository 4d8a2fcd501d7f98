// SPDX-License-Identifier: Apache-2.0
/// \file
/// Files with the results of single stages of `relief make`, for --keep-stages.
/// Tests: tests/make/make_stages_test.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "relief/make/asset.h"

namespace relief::tools {

/// Returns the number of a stage in the names of its files, from 1 on.
int stage_number(std::string_view stage);

/// "06-bake-normal.png", for a name of make::maps_of().
std::string map_file_name(std::string_view map);

/// The files in a folder: a mesh for each stage of make::stages_of(), "03-decimate.glb", and the
/// maps with the names of make::maps_of(), "06-bake-normal.png". A stage has the same number in all
/// jobs. "02-remesh.glb" exists only if the mesh was remeshed.
class StageFiles {
  public:
    StageFiles(const std::filesystem::path& folder, const make::AssetOptions& options);

    /// All files that can be written.
    [[nodiscard]] std::vector<std::filesystem::path> all() const;

    [[nodiscard]] std::filesystem::path mesh_file(std::string_view stage) const {
        return file_of(stage, ".glb");
    }

    /// Writes the maps of an asset. \throws FileError \return the files
    std::vector<std::filesystem::path> write_maps(const make::Asset& asset) const;

  private:
    [[nodiscard]] std::filesystem::path file_of(std::string_view stage,
                                                std::string_view ending) const;

    std::filesystem::path folder_;
    std::vector<std::string> stages_;
    std::vector<std::string> maps_;  ///< The names of all maps that an asset may have.
};

}  // namespace relief::tools
