// SPDX-License-Identifier: Apache-2.0
// Reads the dense model of an asset. Tests: tests/tools/relief_make_test.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "common/model_file.h"
#include "dense_model.h"
#include "make_job.h"
#include "make_parts.h"
#include "mesh_models.h"

namespace relief::tools {
namespace {

/// \throws FileError if the model moves
void require_static(const std::filesystem::path& file, const GltfDocument& document,
                    Report& report) {
    std::vector<std::string> moving;
    for (const std::string& content : document.unsupported_contents()) {
        const bool moves = content.find("animation") != std::string::npos ||
                           content.find("skin") != std::string::npos ||
                           content.find("morph target") != std::string::npos;
        if (moves) {
            moving.push_back(content);
        } else {
            report.add(content, "model", 0, "is not a part of the asset");
        }
    }
    if (moving.empty()) return;
    throw failure(file,
                  fmt::format("has {}, which an asset of one static mesh would lose",
                              fmt::join(moving, ", ")),
                  "export the pose as a static model; relief-mesh decimate and lods keep motion");
}

/// Returns the problem of an image; empty if it can be read.
std::string fault_of(const MapAppearance& appearance, std::size_t image) {
    const GltfImage& source = appearance.images[image];
    if (!source.fault.empty()) return source.fault;
    const auto* file = std::get_if<std::filesystem::path>(&source.source);
    if (file == nullptr || std::filesystem::exists(*file)) return "";
    return fmt::format("image {} is missing", file->string());
}

/// The textures that maps of the asset get.
constexpr std::array transferred_slots = {TextureSlot::normal, TextureSlot::base_color,
                                          TextureSlot::metallic_roughness, TextureSlot::occlusion,
                                          TextureSlot::emission};

bool is_transferred(TextureSlot slot) {
    return std::ranges::find(transferred_slots, slot) != transferred_slots.end();
}

/// Removes textures whose images are missing.
void drop_missing_textures(MapAppearance& appearance, Report& report) {
    for (std::size_t i = 0; i < appearance.materials.size(); ++i) {
        GltfMaterial& material = appearance.materials[i];
        for (const TextureSlot slot : transferred_slots) {
            const Texture* texture = find_texture(material, slot);
            if (texture == nullptr) continue;
            const std::string fault = fault_of(appearance, texture->image);
            if (fault.empty()) continue;
            report.add(fmt::format("{} texture that cannot be read", slot_info(slot).name),
                       "material", i, fmt::format("is left out: {}", fault));
            remove_texture(material, slot);
        }
    }
}

/// The materials of the triangles, as they are read and as the bake uses them.
struct UsedMaterial {
    std::size_t number = 0;  ///< For reports.
    const GltfMaterial* source = nullptr;
    HighMaterial* high = nullptr;
};

/// Reports what the asset does not get.
void report_others(std::span<const UsedMaterial> used, Report& report) {
    for (const auto& [number, material, high] : used) {
        for (const TextureSlotInfo& slot : texture_slots) {
            if (is_transferred(slot.slot) || find_texture(*material, slot.slot) == nullptr)
                continue;
            report.add(fmt::format("{} texture of the source", slot.name), "material", number,
                       "is not transferred");
        }
        for (const std::string& extension : material->more_extensions)
            report.add(extension + " of the source", "material", number, "is not transferred");
        if (material->unlit)
            report.add("unlit material of the source", "material", number, "is lit");
    }
}

/// Returns the beginning of a path in glTF: "extensions/KHR_materials_clearcoat/".
std::string_view extension_path(std::string_view path) {
    const std::string_view start = "extensions/";
    if (!path.starts_with(start)) return {};
    return path.substr(0, path.find('/', start.size()) + 1);
}

/// Returns whether a material has a texture of an extension.
bool has_texture_of(const GltfMaterial& material, std::string_view extension) {
    return std::ranges::any_of(texture_slots, [&](const TextureSlotInfo& slot) {
        return std::string_view(slot.gltf).starts_with(extension) &&
               find_texture(material, slot.slot) != nullptr;
    });
}

/// Copies the factors of extensions that all materials share. The directions of anisotropy belong
/// to the old texture coordinates.
void set_shared_factors(std::span<const UsedMaterial> used, GltfMaterial& shared, Report& report) {
    if (used.empty()) return;
    const auto of = [](const UsedMaterial& material) -> const MetallicRoughness& {
        return *material.source->metallic_roughness;
    };
    for_each_field<MetallicRoughness>([&](const auto& field) {
        using Value = std::decay_t<decltype(field.default_value())>;
        if constexpr (std::is_same_v<Value, float> || std::is_same_v<Value, glm::vec3> ||
                      std::is_same_v<Value, std::optional<float>>) {
            const std::string_view extension = extension_path(field.gltf);
            if (extension.empty()) return;  // It is baked.
            const Value first = of(used.front()).*field.member;
            const bool is_shared = extension != "extensions/KHR_materials_anisotropy/" &&
                                   std::ranges::all_of(used, [&](const UsedMaterial& material) {
                                       return of(material).*field.member == first &&
                                              !has_texture_of(*material.source, extension);
                                   });
            if (is_shared) {
                (*shared.metallic_roughness).*field.member = first;
                return;
            }
            for (const UsedMaterial& material : used) {
                if (of(material).*field.member == field.default_value()) continue;
                report.add(fmt::format("{} of single materials", field.label()), "material",
                           material.number, "is not transferred");
            }
        }
    });
}

/// If only some parts have texture coordinates, the others get (0, 0): their materials have no
/// textures.
void add_missing_texcoords(std::vector<MapModelPart>& parts) {
    const auto has_texcoords = [](const MapModelPart& part) {
        return !part.mesh.texcoords.empty();
    };
    if (std::ranges::none_of(parts, has_texcoords)) return;
    for (MapModelPart& part : parts)
        part.mesh.texcoords.resize(part.mesh.positions.size(), glm::vec2(0.0F));
}

std::size_t triangles_of(const MapModel& model) {
    std::size_t count = 0;
    for (const MapModelPart& part : model.parts)
        count += part.mesh.triangles.size();
    return count;
}

/// A joined mesh has normals only if all parts have them.
void report_lost_normals(const std::vector<MapModelPart>& parts, Report& report) {
    const auto has_normals = [](const MapModelPart& part) { return !part.mesh.normals.empty(); };
    if (std::ranges::all_of(parts, has_normals)) return;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (has_normals(parts[i]))
            report.add("normals of a part beside one without", "part", i, "are computed anew");
    }
}

/// The models of a source.
struct SourceModels {
    std::vector<std::filesystem::path> files;
    std::vector<MapAppearance> appearances;  ///< By file.
    std::vector<MapModelPart> parts;         ///< Of all files; materials are numbered through.
    make::NamedParts names;                  ///< Of the triangles of `parts`.
    glm::dvec3 origin{0.0};
};

void add_model(const std::filesystem::path& file, SourceModels& models, SourceFacts& facts,
               Report& report) {
    const std::string format = format_name(readable_format(file));
    Model contents = read_model(file, report);
    if (const auto* document = std::get_if<GltfDocument>(&contents))
        require_static(file, *document, report);
    MapModel model =
        about(file, [&] { return map_model(std::move(contents), ModelSpace::world, report); });
    if (models.files.empty()) {
        facts.format = format;
        models.origin = model.origin;
    } else {
        move_to(model, models.origin);
    }
    facts.triangles += triangles_of(model);
    std::size_t first = 0;
    for (const MapAppearance& appearance : models.appearances)
        first += appearance.materials.size();
    for (MapModelPart& part : model.parts) {
        for (MaterialRange& range : part.mesh.material_ranges) {
            if (range.material) *range.material += static_cast<std::uint32_t>(first);
        }
        add_named_parts(part, file.stem().string(), BakeSide::high, models.names);
        models.parts.push_back(std::move(part));
    }
    drop_missing_textures(model.appearance, report);
    models.files.push_back(file);
    models.appearances.push_back(std::move(model.appearance));
}

/// Returns the materials that triangles of the source have, in their order.
std::vector<UsedMaterial> used_materials(const SourceModels& models, make::AssetSource& source) {
    std::vector<const GltfMaterial*> all;
    for (const MapAppearance& appearance : models.appearances) {
        for (const GltfMaterial& material : appearance.materials)
            all.push_back(&material);
    }
    std::set<std::size_t> numbers;
    for (const MaterialRange& range : source.mesh.material_ranges) {
        if (range.material && range.triangle_count > 0) numbers.insert(*range.material);
    }
    std::vector<UsedMaterial> used;
    for (const std::size_t number : numbers)
        used.push_back({number, all.at(number), &source.materials.at(number)});
    return used;
}

/// Rotates a source with z up. Its texture coordinates and tangent space stay.
void turn_up(make::AssetSource& source) {
    source.origin = y_up(source.origin);
    for (glm::vec3& position : source.mesh.positions)
        position = y_up(position);
    for (glm::vec3& normal : source.mesh.normals)
        normal = y_up(normal);
    for (glm::vec4& tangent : source.mesh.tangents)
        tangent = glm::vec4(y_up(glm::vec3(tangent)), tangent.w);
}

}  // namespace

make::AssetSource read_source(const DenseModel& model, SourceFacts& facts, Findings& findings) {
    Report report;
    SourceModels models;
    for (const std::filesystem::path& file : model.files)
        add_model(file, models, facts, report);
    const std::filesystem::path& file = model.files.front();
    make::AssetSource source;
    source.origin = models.origin;
    source.crease_angle = model.crease_angle;
    source.parts = std::move(models.names);
    add_missing_texcoords(models.parts);
    report_lost_normals(models.parts, report);
    source.mesh = about(file, [&] { return joined(std::move(models.parts)); });
    if (model.has_z_up) turn_up(source);
    facts.has_z_up = model.has_z_up;
    facts.vertices = source.mesh.positions.size();
    HighTextures textures;
    constexpr HighProperties all{.colors = true, .surfaces = true, .emission = true};
    for (std::size_t i = 0; i < models.files.size(); ++i) {
        textures.add(models.files[i], source.mesh, models.appearances[i], {}, all, report);
        const std::vector<HighMaterial>& added = textures.materials().back().materials;
        source.materials.insert(source.materials.end(), added.begin(), added.end());
        for (const GltfMaterial& material : models.appearances[i].materials) {
            source.material_names.push_back(material.name);
            source.draw_modes.push_back(
                {material.alpha_mode, material.alpha_cutoff, material.double_sided});
        }
    }
    facts.textures = textures.description();
    const std::vector<UsedMaterial> used = used_materials(models, source);
    report_others(used, report);
    set_shared_factors(used, source.shared, report);
    findings.add("read", report);
    return source;
}

}  // namespace relief::tools
