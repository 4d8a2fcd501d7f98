// SPDX-License-Identifier: Apache-2.0
// Reads the dense model of an asset. Tests: tests/tools/relief_make_test.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/model_file.h"
#include "make_job.h"
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

/// Removes textures whose images are missing.
void drop_missing_textures(MapAppearance& appearance, Report& report) {
    for (std::size_t i = 0; i < appearance.materials.size(); ++i) {
        GltfMaterial& material = appearance.materials[i];
        const auto is_missing = [&](TextureSlot slot) {
            const Texture* texture = find_texture(material, slot);
            if (texture == nullptr) return false;
            const std::string fault = fault_of(appearance, texture->image);
            if (fault.empty()) return false;
            report.add(fmt::format("{} texture that cannot be read", slot_info(slot).name),
                       "material", i, fmt::format("is left out: {}", fault));
            return true;
        };
        if (is_missing(TextureSlot::normal)) material.normal_map.reset();
        if (is_missing(TextureSlot::base_color)) material.diffuse_texture.reset();
    }
}

/// Reports textures that the asset does not get.
void report_other_textures(const MapAppearance& appearance, Report& report) {
    for (const TextureSlot slot :
         {TextureSlot::metallic_roughness, TextureSlot::emission, TextureSlot::occlusion}) {
        for (std::size_t i = 0; i < appearance.materials.size(); ++i) {
            if (find_texture(appearance.materials[i], slot) == nullptr) continue;
            report.add(fmt::format("{} texture of the source", slot_info(slot).name), "material", i,
                       "is not transferred");
        }
    }
}

/// Returns the roughness that all materials have; otherwise their mean, which is reported. Metallic
/// surfaces are reported, too.
float common_roughness(const MapAppearance& appearance, Report& report) {
    if (appearance.materials.empty()) return 1.0F;
    constexpr float tolerance = 0.01F;
    float sum = 0.0F, min = 1.0F, max = 0.0F;
    for (std::size_t i = 0; i < appearance.materials.size(); ++i) {
        const MetallicRoughness& surface = *appearance.materials[i].metallic_roughness;
        sum += surface.roughness;
        min = std::min(min, surface.roughness);
        max = std::max(max, surface.roughness);
        if (surface.metallic > 0.0F) {
            report.add("metallic material of the source", "material", i,
                       "is not metallic in the asset");
        }
    }
    if (max - min <= tolerance) return max;
    const float mean = sum / static_cast<float>(appearance.materials.size());
    report.add("source with materials of different roughness", "source", 0,
               fmt::format("has the mean, {:.2f}, everywhere", mean));
    return mean;
}

std::size_t triangles_of(const MapModel& model) {
    std::size_t count = 0;
    for (const MapModelPart& part : model.parts)
        count += part.mesh.triangles.size();
    return count;
}

}  // namespace

make::AssetSource read_source(const std::filesystem::path& file, SourceFacts& facts,
                              Findings& findings) {
    Report report;
    facts.format = format_name(readable_format(file));
    Model contents = read_model(file, report);
    if (const auto* document = std::get_if<GltfDocument>(&contents))
        require_static(file, *document, report);
    MapModel model =
        about(file, [&] { return map_model(std::move(contents), ModelSpace::world, report); });
    facts.triangles = triangles_of(model);
    MapAppearance appearance = std::move(model.appearance);
    drop_missing_textures(appearance, report);
    report_other_textures(appearance, report);
    make::AssetSource source;
    source.origin = model.origin;
    source.roughness = common_roughness(appearance, report);
    source.mesh = about(file, [&] { return joined(std::move(model.parts)); });
    facts.vertices = source.mesh.positions.size();
    HighTextures textures;
    textures.add(file, source.mesh, appearance, {}, true, report);
    const HighMaterials& materials = textures.materials().front();
    source.materials = materials.materials;
    source.otherwise = materials.otherwise;
    if (textures.alpha()) {
        source.alpha_mode = textures.alpha()->mode;
        source.alpha_cutoff = textures.alpha()->cutoff;
    }
    facts.textures = textures.description();
    findings.add("read", report);
    return source;
}

}  // namespace relief::tools
