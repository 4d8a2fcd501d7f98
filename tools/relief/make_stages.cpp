// SPDX-License-Identifier: Apache-2.0
// Writes the results of single stages. Tests: tests/make/make_stages_test.cpp.
#include "make_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {
namespace {

constexpr std::string_view bake_stage = "bake";

}  // namespace

StageFiles::StageFiles(const std::filesystem::path& folder, const make::AssetOptions& options)
    : folder_(folder), stages_(make::stages_of(options)), has_occlusion_(options.occlusion) {}

std::filesystem::path StageFiles::file_of(std::string_view stage, std::string_view ending) const {
    const auto number = std::ranges::find(stages_, stage) - stages_.begin() + 1;
    return folder_ / fmt::format("{:02}-{}{}", number, stage, ending);
}

std::vector<std::filesystem::path> StageFiles::all() const {
    std::vector<std::filesystem::path> files;
    for (const std::string& stage : stages_) {
        if (stage != bake_stage) files.push_back(file_of(stage, ".glb"));
    }
    files.push_back(file_of(bake_stage, "-normal.png"));
    if (has_occlusion_) files.push_back(file_of(bake_stage, "-occlusion.png"));
    files.push_back(file_of(bake_stage, "-color.png"));
    return files;
}

std::filesystem::path StageFiles::write_mesh(std::string_view stage, const Mesh& mesh,
                                             const glm::dvec3& origin, Report& report) const {
    MeshFile contents;
    contents.mesh = mesh;
    contents.mesh.name = stage;
    contents.mesh.material_ranges.clear();  // The materials are those of the source.
    contents.origin = origin;
    const std::filesystem::path file = file_of(stage, ".glb");
    GltfDocument::from_mesh(contents, report).write(file, report);
    return file;
}

std::vector<std::filesystem::path> StageFiles::write_maps(const make::Asset& asset) const {
    std::vector<std::filesystem::path> files;
    const auto write = [&](std::string_view ending, const Image& map,
                           const std::map<std::string, std::string>& metadata) {
        files.push_back(file_of(bake_stage, ending));
        write_image(files.back(), map, metadata);
    };
    NormalMapFormat format;
    format.bits = 8;
    write("-normal.png", asset.normal_map, normal_map_metadata(format));
    if (asset.occlusion_map) {
        write("-occlusion.png", *asset.occlusion_map,
              write_description({.kind = MapKind::occlusion, .color_space = ColorSpace::data}, 8));
    }
    if (asset.color_map) {
        MapDescription colors{.kind = MapKind::color, .color_space = ColorSpace::srgb};
        if (asset.color_map->channels == 4) colors.alpha = AlphaContent::opacity;
        write("-color.png", *asset.color_map, write_description(colors, 8));
    }
    return files;
}

}  // namespace relief::tools
