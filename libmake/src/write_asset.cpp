// SPDX-License-Identifier: Apache-2.0
// Writes an asset as glTF, with its maps and levels of detail. Tests: tests/make/asset_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "file_replacement.h"
#include "relief/make/asset.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/model.h"
#include "relief/mesh/topology.h"

namespace relief::make {
namespace {

/// "rock", or "rock_mask" and "rock_blend" beside it.
std::string material_name(const Asset& asset, const DrawMode& mode) {
    if (asset.draw_modes.empty() || mode.alpha_mode == AlphaMode::opaque) return asset.name;
    return fmt::format("{}_{}", asset.name, enum_name(mode.alpha_mode));
}

/// Sorts the triangles by material, so that each is one primitive.
void sort_by_material(Mesh& mesh, std::size_t materials) {
    std::vector<std::vector<glm::uvec3>> triangles(materials);
    for (const MaterialRange& range : mesh.material_ranges) {
        const auto first = mesh.triangles.begin() + range.first_triangle;
        std::vector<glm::uvec3>& of_material = triangles.at(range.material.value_or(0));
        of_material.insert(of_material.end(), first, first + range.triangle_count);
    }
    mesh.triangles.clear();
    mesh.material_ranges.clear();
    for (std::uint32_t i = 0; i < materials; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.triangles.size());
        mesh.triangles.insert(mesh.triangles.end(), triangles[i].begin(), triangles[i].end());
        mesh.material_ranges.push_back({first, static_cast<std::uint32_t>(triangles[i].size()), i});
    }
}

GltfDocument document_of(const Asset& asset, Report& report) {
    MeshFile contents;
    contents.mesh = asset.mesh;
    contents.mesh.name = asset.name;
    contents.origin = asset.origin;
    for (const DrawMode& mode : draw_modes_of(asset)) {
        MtlMaterial material;  // Its factors are set later.
        material.name = material_name(asset, mode);
        contents.materials.push_back(material);
    }
    if (asset.draw_modes.empty()) {
        const auto count = static_cast<std::uint32_t>(asset.mesh.triangles.size());
        contents.mesh.material_ranges = {{0, count, 0U}};
    } else {
        sort_by_material(contents.mesh, contents.materials.size());
    }
    return GltfDocument::from_mesh(contents, report);
}

/// Stores the factors and the maps in the materials, which share the maps. The files of the maps,
/// which have their names, exist only until the document has read them.
void store_materials(GltfDocument& document, const std::filesystem::path& file, const Asset& asset,
                     Report& report) {
    const std::vector<DrawMode> modes = draw_modes_of(asset);
    GltfMaterial factors = asset.material;
    for (std::size_t i = 0; i < modes.size(); ++i) {
        factors.double_sided = modes[i].double_sided;
        document.set_factors(i, factors);
        document.set_alpha_mode(i, modes[i].alpha_mode, modes[i].alpha_cutoff);
    }
    const relief::detail::FileSet temporary;  // It is never committed.
    for (const AssetMap& map : maps_of(asset)) {
        if (map.slots.empty()) continue;
        const std::filesystem::path image =
            file.parent_path() / fmt::format("{}_{}.png", file.stem().string(), map.name);
        write_image(image, *map.image, map.metadata);
        for (std::size_t i = 0; i < modes.size(); ++i) {
            for (const TextureSlot slot : map.slots)
                document.set_texture(i, slot, image, GltfImageStorage::embedded, report);
        }
    }
}

/// The screen on which the pixels of levels are counted, and the error of a level at its switch.
constexpr double screen_width = 1920.0;
constexpr double screen_height = 1080.0;
constexpr double pixel_error = 0.5;

/// Returns the positions and triangles.
Mesh surface_of(const Mesh& mesh) {
    Mesh surface;
    surface.positions = mesh.positions;
    surface.triangles = mesh.triangles;
    return surface;
}

double diameter_of(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    return bounds.empty() ? 0.0 : glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
}

void set_switch(AssetLevel& level, double diameter, double largest_pixels) {
    level.pixels = level.distance > 0.0 ? pixel_error * diameter / level.distance : screen_height;
    level.pixels = std::min(level.pixels, largest_pixels);
    const double area = std::numbers::pi / 4.0 * level.pixels * level.pixels;
    level.coverage = std::min(1.0, area / (screen_width * screen_height));
}

/// Adds levels below the only mesh of a document. They share its maps: seams are kept.
std::vector<AssetLevel> add_levels(GltfDocument& document, const Asset& asset, std::size_t count,
                                   Report& report) {
    // A level that has more than this part of the triangles of the one before is useless.
    constexpr double max_part = 0.75;
    std::vector<AssetLevel> levels;
    std::vector<GltfLevel> of_document;
    std::size_t last = 0;
    std::size_t triangles = asset.mesh.triangles.size();
    const Mesh finest = surface_of(asset.mesh);
    const double diameter = diameter_of(finest);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t target = document.copy_mesh(last);
        AssetLevel level;
        Mesh surface;
        const ChangedModel changed = change_triangles(
            document, std::array{target}, NormalMode::keep,
            [&](const TriangleInput& before, Report& more) {
                DecimateOptions limits;
                limits.triangles = std::max<std::size_t>(1, triangles / 2);
                limits.fit_positions = true;
                FramedMesh after = decimated(before.mesh, limits, more, before.deformation);
                surface = surface_of(after.mesh);
                return after;
            });
        level.triangles = changed.triangles_written;
        if (static_cast<double>(level.triangles) > max_part * static_cast<double>(triangles)) {
            document.remove_last_mesh();
            report.add("level of detail that cannot get smaller", "level", i + 1, "is left out");
            break;
        }
        const SurfaceDistance distance = surface_distance(finest, surface);
        level.distance = std::max(distance.from_a.max, distance.from_b.max);
        set_switch(level, diameter, levels.empty() ? screen_height : levels.back().pixels);
        levels.push_back(level);
        of_document.push_back({target, level.coverage});
        last = target;
        triangles = level.triangles;
    }
    if (!of_document.empty()) document.set_levels_of_detail(0, of_document, false);
    return levels;
}

}  // namespace

std::vector<AssetLevel> write_asset(const std::filesystem::path& file, const Asset& asset,
                                    std::size_t levels, Report& report) {
    GltfDocument document = document_of(asset, report);
    store_materials(document, file, asset, report);
    std::vector<AssetLevel> added = add_levels(document, asset, levels, report);
    document.write(file, report);
    return added;
}

}  // namespace relief::make
