// SPDX-License-Identifier: Apache-2.0
// Reads a written asset back and checks it. Tests: tests/make/asset_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "relief/make/asset.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/model.h"
#include "relief/mesh/tangents.h"

namespace relief::make {
namespace {

constexpr const char* outcome = "is not what was made";

/// Adds what was found in a level of detail. Its triangles use the texels of the whole mesh, and no
/// bake follows.
void add_of_level(const Finding& finding, Report& problems) {
    Finding theirs = finding;
    if (theirs.kind == condition_info(MeshCondition::texture_overlapping).word) {
        theirs.kind = "overlapping texture in a level of detail";
        theirs.outcome = "shows texels that another triangle shows too";
    }
    problems.add(theirs);
}

/// Returns the method of the tangents of the finest mesh. Its primitives have those of the whole
/// mesh, which differ at their borders from those that each would have alone.
IdentifiedTangents tangents_of_all(const GltfDocument& document, std::size_t materials) {
    std::vector<MapModelPart> parts;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        if (parts.size() < materials) parts.push_back({"", document.mesh(id)});
    }
    return identify_tangents(joined(std::move(parts)));
}

/// \param materials  the number of primitives of the finest mesh
void check_meshes(const CheckedModel& checked, const GltfDocument& document, std::size_t materials,
                  Report& problems) {
    std::optional<IdentifiedTangents> of_all;
    if (materials > 1) of_all = tangents_of_all(document, materials);
    for (const CheckedPart& part : checked.parts) {
        const auto index = static_cast<std::size_t>(&part - checked.parts.data());
        for (const Finding& finding : part.problems.findings())
            index < materials ? problems.add(finding) : add_of_level(finding, problems);
        const bool has_frames = part.tangents && !part.tangents->identified.agreements.empty();
        if (!has_frames) {
            problems.add("mesh without tangents", "primitive", index, outcome);
            continue;
        }
        const IdentifiedTangents& identified =
            of_all && index < materials ? *of_all : part.tangents->identified;
        if (identified.method != TangentMethod::mikktspace &&
            std::ranges::count(identified.equivalent_methods, TangentMethod::mikktspace) == 0) {
            problems.add("tangents that are not MikkTSpace's", "primitive", index, outcome);
        }
    }
}

/// \return the image; absent if it is missing
std::optional<std::size_t> check_map(const GltfView& view, TextureSlot slot, const Image& expected,
                                     Report& problems) {
    const Texture* texture = find_texture(view.materials.front(), slot);
    const auto* bytes =
        texture == nullptr
            ? nullptr
            : std::get_if<std::vector<std::byte>>(&view.images[texture->image].source);
    const auto index = static_cast<std::size_t>(slot);
    if (bytes == nullptr || bytes->empty()) {
        problems.add("missing map", "texture", index, outcome);
        return std::nullopt;
    }
    const Image stored = read_image(*bytes, "map", slot_info(slot).use);
    if (stored.width != expected.width || stored.height != expected.height ||
        stored.samples != expected.samples)
        problems.add("map with other texels", "texture", index, outcome);
    return texture->image;
}

/// The factors are written as decimal numbers that are read back exactly.
void check_factors(const GltfMaterial& material, const GltfMaterial& expected, Report& problems) {
    const auto check = [&](const char* name, bool is_same) {
        if (!is_same) problems.add(fmt::format("another {}", name), "material", 0, outcome);
    };
    for_each_field<MetallicRoughness>([&](const auto& field) {
        using Value = std::decay_t<decltype(field.default_value())>;
        if constexpr (std::is_same_v<Value, float> || std::is_same_v<Value, glm::vec3> ||
                      std::is_same_v<Value, std::optional<float>>) {
            check(field.name, (*material.metallic_roughness).*field.member ==
                                  (*expected.metallic_roughness).*field.member);
        }
    });
    check("opacity", material.opacity == expected.opacity);
    check("emission", material.emission_factor == expected.emission_factor &&
                          material.emission_strength == expected.emission_strength);
}

void check_draw_mode(const GltfMaterial& material, const DrawMode& expected, std::size_t index,
                     Report& problems) {
    const bool is_masked = expected.alpha_mode == AlphaMode::mask;
    if (material.alpha_mode != expected.alpha_mode ||
        (is_masked && material.alpha_cutoff != expected.alpha_cutoff))
        problems.add("another alpha mode", "material", index, outcome);
    if (material.double_sided != expected.double_sided)
        problems.add("another number of sides", "material", index, outcome);
}

std::size_t triangles_of(const GltfDocument& document, std::size_t materials) {
    const std::vector<GltfPrimitiveId> ids = document.triangle_primitives();
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < std::min(materials, ids.size()); ++i)
        triangles += document.mesh(ids[i]).triangles.size();
    return triangles;
}

}  // namespace

Report verify_asset(const std::filesystem::path& file, const Asset& asset) {
    Report reading;
    const Model model = GltfDocument::read(file, reading);
    Report problems;
    problems.merge(reading);
    const std::vector<DrawMode> modes = draw_modes_of(asset);
    const auto& document = std::get<GltfDocument>(model);
    check_meshes(check_model(model, reading, true), document, modes.size(), problems);
    const GltfView view = document.view();
    if (view.materials.size() != modes.size()) {
        problems.add(fmt::format("another number of materials than {}", modes.size()), "material",
                     view.materials.size(), outcome);
        return problems;
    }
    if (triangles_of(document, modes.size()) != asset.mesh.triangles.size())
        problems.add("another number of triangles", "mesh", 0, outcome);
    for (const AssetMap& map : maps_of(asset)) {
        for (const TextureSlot slot : map.slots) {
            const std::optional<std::size_t> image = check_map(view, slot, *map.image, problems);
            for (const GltfMaterial& material : view.materials) {
                const Texture* texture = find_texture(material, slot);
                if (image && (texture == nullptr || texture->image != *image))
                    problems.add("missing map", "texture", static_cast<std::size_t>(slot), outcome);
            }
        }
    }
    for (std::size_t i = 0; i < modes.size(); ++i) {
        check_factors(view.materials[i], asset.material, problems);
        check_draw_mode(view.materials[i], modes[i], i, problems);
    }
    return problems;
}

}  // namespace relief::make
