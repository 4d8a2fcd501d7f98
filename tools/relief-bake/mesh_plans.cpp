// SPDX-License-Identifier: Apache-2.0
// Plans the maps of a bake: the triangles of the low mesh are split by material, then by tile.
// Tests: tests/tools/relief_bake_mesh_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "mesh_bake.h"
#include "relief/mesh/texel_coverage.h"

namespace relief::tools {
namespace {

/// The triangles of a material, and its names.
struct MaterialPart {
    std::string name;
    std::string file_name;  ///< The name in file names.
    std::vector<std::uint32_t> triangles;
};

std::string safe_file_name(const std::string& name) {
    std::string safe = name;
    for (char& letter : safe) {
        const auto code = static_cast<unsigned char>(letter);
        const bool is_safe = code >= 0x80 || std::isalnum(code) != 0 || letter == '-' ||
                             letter == '_' || letter == '.';
        if (!is_safe) letter = '_';
    }
    if (safe.starts_with('.')) safe.front() = '_';
    return safe;
}

MaterialPart named_part(std::optional<std::uint32_t> material,
                        const std::vector<std::string>& names) {
    if (!material) return {"no-material", "no-material", {}};
    std::string name = *material < names.size() ? names[*material] : "";
    if (name.empty()) name = fmt::format("material-{}", *material);
    return {name, safe_file_name(name), {}};
}

/// Splits a mesh by material. Triangles without a material come first.
std::vector<MaterialPart> material_parts(const Mesh& low, const std::vector<std::string>& names) {
    std::map<std::optional<std::uint32_t>, MaterialPart> parts;
    std::vector<MaterialRange> ranges = low.material_ranges;
    if (ranges.empty())
        ranges.push_back({0, static_cast<std::uint32_t>(low.triangles.size()), std::nullopt});
    for (const MaterialRange& range : ranges) {
        if (range.triangle_count == 0) continue;
        MaterialPart& part =
            parts.emplace(range.material, named_part(range.material, names)).first->second;
        for (std::uint32_t i = 0; i < range.triangle_count; ++i)
            part.triangles.push_back(range.first_triangle + i);
    }
    std::vector<MaterialPart> result;
    for (auto& [index, part] : parts) {
        std::ranges::sort(part.triangles);
        result.push_back(std::move(part));
    }
    return result;
}

void report_outside(const MapTiles& tiles, const std::string& remedy, Report& report) {
    for (const std::uint32_t triangle : tiles.outside)
        report.add("triangle outside of the map", "triangle", triangle, "is not baked" + remedy);
    for (const std::uint32_t triangle : tiles.partly_outside) {
        report.add("triangle partly outside of the map", "triangle", triangle,
                   "is baked only inside the map" + remedy);
    }
}

/// Adds the plan of some triangles: one map, or one per tile.
void add_maps(const MeshBakeRequest& request, const Mesh& low, const MapPlan& plan,
              MapPlans& plans) {
    const bool has_tiles = names_word(request.output, tile_word);
    if (!has_tiles && request.bake.placement.repeat) {
        plans.maps.push_back(plan);
        return;
    }
    const std::optional<std::span<const std::uint32_t>> triangles =
        plan.triangles ? std::optional<std::span<const std::uint32_t>>(*plan.triangles)
                       : std::nullopt;
    MapTiles tiles =
        tiles_of(low.texcoords, low.triangles, triangles, has_tiles ? udim_tiles : TileRange{});
    report_outside(tiles, has_tiles ? "" : "; <UDIM> in the map's name gives a map for each tile",
                   plans.report);
    if (!has_tiles) {
        plans.maps.push_back(plan);
        return;
    }
    for (const std::uint32_t triangle : tiles.not_finite)
        plans.report.add("texture not finite", "triangle", triangle, "covers no texel");
    for (MapTile& tile : tiles.tiles) {
        MapPlan tile_plan = plan;
        tile_plan.tile = tile.tile;
        tile_plan.udim = udim_of(tile.tile);
        tile_plan.triangles = std::move(tile.triangles);
        tile_plan.output = with_word(plan.output, tile_word, fmt::format("{}", *tile_plan.udim));
        plans.maps.push_back(std::move(tile_plan));
    }
}

/// Checks that each output is a separate file, and none of the models.
void check_files(const MeshBakeRequest& request, const std::vector<MapPlan>& maps) {
    std::map<std::filesystem::path, std::string> used;
    for (const std::filesystem::path& file : request.high)
        used[identity_of(file)] = "a model";
    used[identity_of(request.low)] = "a model";
    if (request.cage) used[identity_of(*request.cage)] = "the cage";
    const auto use = [&](const std::filesystem::path& file, const std::string& name) {
        const auto [other, is_new] = used.emplace(identity_of(file), name);
        if (is_new) return;
        throw failure(
            request.low,
            fmt::format("{} and {} would be the same file {}", other->second, name, file.string()),
            "give one of them another name");
    };
    for (const MapPlan& map : maps) {
        use(map.output, map.name().empty() ? "the map" : map.name());
        for (const auto& [kind, file] : request.layers.files) {
            use(map.named(file), fmt::format("{}{}{}", layer_name(kind),
                                             map.name().empty() ? "" : " of ", map.name()));
        }
    }
}

bool has_word_twice(const std::filesystem::path& file, std::string_view word) {
    return names_word(with_word(file, word, ""), word);
}

}  // namespace

std::filesystem::path MapPlan::named(const std::filesystem::path& file) const {
    std::filesystem::path result = file;
    if (material) result = with_word(result, material_word, material_in_files);
    if (udim) result = with_word(result, tile_word, fmt::format("{}", *udim));
    return result;
}

std::string MapPlan::name() const {
    const std::string number = udim ? fmt::format("tile {}", *udim) : "";
    if (!material) return number;
    return fmt::format("material '{}'{}", *material, udim ? ", " + number : "");
}

BakeMapOptions map_options(const BakeOptions& options, const MapPlan& plan) {
    BakeMapOptions map = options;
    map.placement.tile = plan.tile;
    if (plan.triangles) map.triangles = *plan.triangles;
    return map;
}

void check_map_names(const MeshBakeRequest& request) {
    const std::filesystem::path& output = request.output;
    for (const auto& [kind, file] : request.layers.files) {
        for (const std::string_view word : {material_word, tile_word}) {
            if (names_word(file, word) == names_word(output, word)) continue;
            throw UsageError(fmt::format("{}: {} must be in the names of all files, or of none",
                                         file.string(), word));
        }
    }
    for (const std::string_view word : {material_word, tile_word}) {
        if (output.parent_path().string().find(word) != std::string::npos)
            throw UsageError(fmt::format("{}: {} is in a folder's name", output.string(), word),
                             "use it only in the file name");
        if (has_word_twice(output, word))
            throw UsageError(fmt::format("{}: {} occurs twice", output.string(), word),
                             "use it once");
    }
    if (names_word(output, tile_word) && request.bake.placement.repeat)
        throw UsageError("--outside repeat: has no effect with <UDIM>, which bakes all tiles");
}

MapPlans plan_maps(const MeshBakeRequest& request, const Mesh& low,
                   const std::vector<std::string>& materials) {
    MapPlans plans;
    std::vector<MaterialPart> parts = material_parts(low, materials);
    plans.materials = parts.size();
    if (names_word(request.output, material_word)) {
        for (MaterialPart& part : parts) {
            MapPlan plan;
            plan.output = with_word(request.output, material_word, part.file_name);
            plan.material = part.name;
            plan.material_in_files = part.file_name;
            plan.triangles = std::move(part.triangles);
            add_maps(request, low, plan, plans);
        }
    } else {
        MapPlan plan;
        plan.output = request.output;
        add_maps(request, low, plan, plans);
    }
    if (plans.maps.empty()) {
        throw failure(request.low, "no triangle lies in a UDIM tile",
                      "remove <UDIM> from the map's name, or move the texture coordinates");
    }
    check_files(request, plans.maps);
    return plans;
}

}  // namespace relief::tools
