// SPDX-License-Identifier: Apache-2.0
// Writes the results of single stages. Tests: tests/make/make_stages_test.cpp.
#include "make_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

constexpr std::string_view bake_stage = "bake";
/// Their order in the numbers of files.
constexpr auto stage_order = std::to_array<std::string_view>(
    {"repair", "remesh", "decimate", "unwrap", "frames", bake_stage});

}  // namespace

int stage_number(std::string_view stage) {
    return 1 + static_cast<int>(std::ranges::find(stage_order, stage) - stage_order.begin());
}

std::string map_file_name(std::string_view map) {
    return fmt::format("{:02}-{}-{}.png", stage_number(bake_stage), bake_stage, map);
}

StageFiles::StageFiles(const std::filesystem::path& folder, const make::AssetOptions& options)
    : folder_(folder), stages_(make::stages_of(options)) {
    maps_ = {"normal", "occlusion", "color", "orm", "emission"};
    for (const LayerKind kind : options.layers)
        maps_.push_back(make::layer_name(kind));
}

std::filesystem::path StageFiles::file_of(std::string_view stage, std::string_view ending) const {
    return folder_ / fmt::format("{:02}-{}{}", stage_number(stage), stage, ending);
}

std::vector<std::filesystem::path> StageFiles::all() const {
    std::vector<std::filesystem::path> files;
    for (const std::string& stage : stages_) {
        if (stage != bake_stage) files.push_back(file_of(stage, ".glb"));
    }
    for (const std::string& map : maps_)
        files.push_back(folder_ / map_file_name(map));
    return files;
}

std::vector<std::filesystem::path> StageFiles::write_maps(const make::Asset& asset) const {
    std::vector<std::filesystem::path> files;
    for (const make::AssetMap& map : make::maps_of(asset)) {
        files.push_back(folder_ / map_file_name(map.name));
        write_image(files.back(), *map.image, map.metadata);
    }
    return files;
}

}  // namespace relief::tools
