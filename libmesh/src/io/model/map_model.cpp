// SPDX-License-Identifier: Apache-2.0
// Reads the meshes, objects and materials of a model for bakes and conversions of maps.
// Tests: tests/tools/map_models_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "relief/mesh/model.h"

namespace relief {
namespace {

MapModelPart part_of(const GltfDocument& document, GltfPrimitiveId id, Report& report) {
    const int set = document.tangent_texcoords(id).set;
    Mesh mesh = document.mesh(id, set);
    if (mesh.normals.empty()) {
        if (!mesh.tangents.empty()) {
            report.add("tangents without normals", "primitive", id.primitive,
                       "are ignored, as glTF requires");
        }
        FrameOptions options;
        options.if_missing = NormalMode::flat;
        options.tangents = TangentMethod::none;
        mesh = with_frames(std::move(mesh), options, report).mesh;
    }
    return {document.describe(id), std::move(mesh), {}, {}, set};
}

/// Sets the emission of a material of MTL. A texture needs a factor to have an effect, but the
/// default of Ke is black.
void set_emission(GltfMaterial& converted, const MtlMaterial& material) {
    converted.emission = glm::max(material.emission, 0.0F);
    if (material.emission_map && converted.emission == glm::vec3(0.0F))
        converted.emission = glm::vec3(1.0F);
    const glm::vec3& emission = converted.emission;
    converted.emission_strength = std::max({emission.r, emission.g, emission.b, 1.0F});
    converted.emission_factor = emission / converted.emission_strength;
}

/// Converts materials by the rules of GltfDocument::from_mesh().
MapAppearance appearance_of(const std::vector<MtlMaterial>& materials, Report& report) {
    MapAppearance appearance;
    const auto add_texture = [&](GltfMaterial& converted, TextureSlot slot,
                                 const MtlMaterial& material,
                                 const std::optional<std::filesystem::path>& file) {
        if (!file) return;
        set_texture(converted, slot, {appearance.images.size()});
        GltfImage image{file->filename().string(), *file};
        if (!material.may_read(*file)) {
            image.source = std::vector<std::byte>();
            image.fault = file->string() + " lies outside of the model's folder";
        }
        appearance.images.push_back(std::move(image));
    };
    for (const MtlMaterial& material : materials) {
        GltfMaterial converted;
        converted.name = material.name;
        // Some programs write the opacity where MTL expects transparency, so 0 means opaque.
        const float opacity = material.opacity > 0.0F ? std::min(material.opacity, 1.0F) : 1.0F;
        MetallicRoughness& surface = *converted.metallic_roughness;
        surface.base_color = glm::clamp(material.diffuse, 0.0F, 1.0F);
        surface.metallic = 0.0F;
        surface.roughness = std::min(
            std::sqrt(std::sqrt(2.0F / (std::max(material.shininess, 0.0F) + 2.0F))), 1.0F);
        set_emission(converted, material);
        converted.opacity = opacity;
        const bool has_alpha_texture =
            material.opacity_map && material.opacity_map == material.diffuse_map;
        if (opacity < 1.0F || has_alpha_texture) converted.alpha_mode = AlphaMode::blend;
        if (material.opacity_map && !has_alpha_texture) {
            report.add(fmt::format("map_d '{}' of material '{}', which is not its map_Kd",
                                   material.opacity_map->string(), material.name),
                       "material", appearance.materials.size(),
                       "is not read (store the opacity in the alpha of map_Kd)");
        }
        add_texture(converted, TextureSlot::base_color, material, material.diffuse_map);
        add_texture(converted, TextureSlot::emission, material, material.emission_map);
        add_texture(converted, TextureSlot::normal, material, material.normal_map);
        appearance.materials.push_back(std::move(converted));
    }
    return appearance;
}

/// If some parts have tangents, the others get those of MikkTSpace.
void add_missing_tangents(MapModel& model, Report& report) {
    const auto has_tangents = [](const MapModelPart& part) { return !part.mesh.tangents.empty(); };
    if (std::none_of(model.parts.begin(), model.parts.end(), has_tangents)) return;
    for (MapModelPart& part : model.parts) {
        if (has_tangents(part) || part.mesh.texcoords.empty()) continue;
        FrameOptions options;
        options.tangents = TangentMethod::mikktspace;
        part.mesh = with_frames(std::move(part.mesh), options, report).mesh;
    }
}

MapModel model_of(const GltfDocument& document, ModelSpace space, Report& report) {
    MapModel model;
    if (space == ModelSpace::object) {
        for (const GltfPrimitiveId id : document.triangle_primitives())
            model.parts.push_back(part_of(document, id, report));
        return model;
    }
    GltfView view = document.view();
    for (const GltfMaterial& material : view.materials)
        model.materials.push_back(material.name);
    for (const auto& primitive : view.primitives) {
        MapModelPart part = part_of(document, primitive.what, report);
        part.objects = {primitive.name};
        part.mesh = transformed(std::move(part.mesh), primitive.world_from_object);
        model.parts.push_back(std::move(part));
    }
    model.appearance = {std::move(view.materials), std::move(view.images)};
    add_missing_tangents(model, report);
    if (view.primitives.size() == 1)
        model.world_from_object = glm::dmat3(glm::dmat4(view.primitives[0].world_from_object));
    return model;
}

/// Parts without colors are white if others have colors.
std::vector<glm::vec4> joined_colors(const std::vector<MapModelPart>& parts) {
    const auto has_colors = [](const MapModelPart& part) { return !part.mesh.colors.empty(); };
    std::vector<glm::vec4> all;
    if (std::none_of(parts.begin(), parts.end(), has_colors)) return all;
    for (const MapModelPart& part : parts) {
        all.insert(all.end(), part.mesh.colors.begin(), part.mesh.colors.end());
        if (!has_colors(part)) all.resize(all.size() + part.mesh.positions.size(), glm::vec4(1.0F));
    }
    return all;
}

/// Joins an attribute of all parts. The result is empty if a part lacks it.
template <typename Value>
std::vector<Value> joined(const std::vector<MapModelPart>& parts,
                          std::vector<Value> Mesh::*attribute) {
    std::vector<Value> all;
    for (const MapModelPart& part : parts) {
        const std::vector<Value>& values = part.mesh.*attribute;
        if (values.empty() && !part.mesh.positions.empty()) return {};
        all.insert(all.end(), values.begin(), values.end());
    }
    return all;
}

/// Appends the material ranges of a part, before its triangles are added.
void append_ranges(Mesh& all, const Mesh& part) {
    const auto first = static_cast<std::uint32_t>(all.triangles.size());
    const auto count = static_cast<std::uint32_t>(part.triangles.size());
    if (part.material_ranges.empty() && count > 0)
        all.material_ranges.push_back({first, count, std::nullopt});
    for (MaterialRange range : part.material_ranges) {
        range.first_triangle += first;
        all.material_ranges.push_back(range);
    }
}

}  // namespace

MapModel map_model(Model model, ModelSpace space, Report& report) {
    if (const auto* document = std::get_if<GltfDocument>(&model))
        return model_of(*document, space, report);
    auto& contents = std::get<MeshFile>(model);
    validate(contents.mesh);
    MapModel result;
    result.parts.push_back({"", std::move(contents.mesh), std::move(contents.objects),
                            std::move(contents.object_of), 0});
    for (const MtlMaterial& material : contents.materials)
        result.materials.push_back(material.name);
    result.appearance = appearance_of(contents.materials, report);
    result.origin = contents.origin;
    result.world_from_object = glm::dmat3(1.0);
    return result;
}

Mesh joined(std::vector<MapModelPart> parts) {
    if (parts.size() == 1) return std::move(parts.front().mesh);
    Mesh all;
    all.positions = joined(parts, &Mesh::positions);
    all.normals = joined(parts, &Mesh::normals);
    all.tangents = joined(parts, &Mesh::tangents);
    all.texcoords = joined(parts, &Mesh::texcoords);
    all.colors = joined_colors(parts);
    if (all.positions.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw InvalidInput(
            fmt::format("{} vertices are too many for one mesh", all.positions.size()));
    }
    std::uint32_t first = 0;
    for (const MapModelPart& part : parts) {
        append_ranges(all, part.mesh);
        for (const glm::uvec3& triangle : part.mesh.triangles)
            all.triangles.push_back(triangle + first);
        first += static_cast<std::uint32_t>(part.mesh.positions.size());
    }
    return all;
}

void move_to(MapModel& model, const glm::dvec3& origin) {
    const glm::dvec3 by = model.origin - origin;
    model.origin = origin;
    if (by == glm::dvec3(0.0)) return;
    for (MapModelPart& part : model.parts) {
        for (glm::vec3& position : part.mesh.positions)
            position = glm::vec3(glm::dvec3(position) + by);
    }
}

}  // namespace relief
