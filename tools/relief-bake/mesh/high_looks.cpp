// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_mesh_looks_test.cpp.
#include "mesh/high_looks.h"

#include <fmt/format.h>

#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
namespace {

void add_look(CLI::App& app, const std::string& name, std::optional<std::filesystem::path>& target,
              const std::string& description) {
    add_value(app, name, "FILE|none", description,
              [&target](const std::string&, const std::string& text) {
                  target = text == "none" ? std::filesystem::path() : std::filesystem::path(text);
              })
        .group("High models");
}

}  // namespace

void add_high_normal_map_option(CLI::App& app, HighLookOptions& options) {
    add_look(app, "--high-normal-map", options.normal_map,
             "A normal map of the high models, green up, that goes on top of their normals; or "
             "none. Default: those of their materials (glTF, MTL's norm).");
}

void add_high_color_option(CLI::App& app, HighLookOptions& options) {
    add_look(app, "--high-color", options.color,
             "The colours of the high models, for --color-map, in place of their materials'; or "
             "none. Default: those of their materials.");
}

const Image* HighLooks::image(const std::filesystem::path& file, ImageUse use) {
    const std::string key = fmt::format("{} {}", file.string(), static_cast<int>(use));
    const auto known = images_.find(key);
    if (known != images_.end()) return &known->second;
    const Image* added = &images_.emplace(key, read_image(file, use)).first->second;
    if (use == ImageUse::data) metadata_[added] = read_image_info(file).metadata;
    return added;
}

SurfaceNormalMap HighLooks::normal_map(const SurfaceTexture& texture, float scale) const {
    const Image& map = *texture.image;
    SurfaceNormalMap result{texture, scale, Green::up, FlatCode::half, {}};
    result.flat = detect_flat_code(map, metadata_.at(&map));
    if (result.flat == FlatCode::half) result.flat_codes = flat_texel_codes(map);
    return result;
}

const Image* HighLooks::image(const std::filesystem::path& model, const MapLooks& looks,
                              std::size_t index, ImageUse use) {
    const GltfImage& source = looks.images[index];
    const char* remedy = "put it there, or use --high-normal-map none, --high-color none";
    if (const auto* file = std::get_if<std::filesystem::path>(&source.source)) {
        if (!std::filesystem::exists(*file))
            throw failure(model, fmt::format("image {} is missing", file->string()), remedy);
        return image(*file, use);
    }
    const std::string name = fmt::format("{}, image {}", model.string(), index);
    const std::string key = fmt::format("{} {}", name, static_cast<int>(use));
    const auto known = images_.find(key);
    if (known != images_.end()) return &known->second;
    const auto& bytes = std::get<std::vector<std::byte>>(source.source);
    if (bytes.empty()) {
        throw failure(model, fmt::format("image {} is outside of its folder", index), remedy);
    }
    const Image* added = &images_.emplace(key, read_image(bytes, name, use)).first->second;
    if (use == ImageUse::data) metadata_[added] = read_image_info(bytes, name).metadata;
    return added;
}

SurfaceTexture HighLooks::texture(const std::filesystem::path& model, const MapLooks& looks,
                                  const GltfTexture& texture, ImageUse use) {
    return {image(model, looks, texture.image, use), texture.wrap_u, texture.wrap_v, texture.filter,
            texture.transform};
}

void HighLooks::add(const std::filesystem::path& file, const Mesh& mesh, const MapLooks& looks,
                    const HighLookOptions& options, bool with_colors, Report& report) {
    HighDetail detail{&mesh, {}, {}};
    for (std::size_t i = 0; i < looks.materials.size(); ++i) {
        const GltfMaterial& look = looks.materials[i];
        HighMaterial material;
        if (look.normal_texture && !options.normal_map) {
            material.normal_map = normal_map(
                texture(file, looks, *look.normal_texture, ImageUse::data), look.normal_scale);
            ++normal_maps_;
        }
        if (with_colors && !options.color) material.color = glm::vec3(look.base_color);
        const bool has_texture = with_colors && !options.color && look.base_color_texture;
        const bool is_elsewhere =
            has_texture && look.normal_texture &&
            look.normal_texture->texcoord_set != look.base_color_texture->texcoord_set;
        if (is_elsewhere) {
            report.add("colour texture by other coordinates than the normal map", "material", i,
                       "is left out");
        } else if (has_texture) {
            material.color_texture =
                texture(file, looks, *look.base_color_texture, ImageUse::color);
            ++color_textures_;
        }
        detail.materials.push_back(std::move(material));
    }
    // Files by option are for all of the mesh, whatever its materials.
    const bool has_normal_map = options.normal_map && !options.normal_map->empty();
    const bool has_color = with_colors && options.color && !options.color->empty();
    if (has_normal_map || has_color) detail.otherwise.emplace();
    const auto each = [&](HighMaterial& material) {
        if (has_normal_map) {
            const SurfaceTexture texture{.image = image(*options.normal_map, ImageUse::data)};
            material.normal_map = normal_map(texture, 1.0F);
        }
        if (has_color)
            material.color_texture =
                SurfaceTexture{.image = image(*options.color, ImageUse::color)};
    };
    for (HighMaterial& material : detail.materials)
        each(material);
    if (detail.otherwise) each(*detail.otherwise);
    normal_maps_ += has_normal_map ? 1 : 0;
    color_textures_ += has_color ? 1 : 0;
    details_.push_back(std::move(detail));
}

std::string HighLooks::words() const {
    std::string words;
    if (normal_maps_ > 0) words = counted(normal_maps_, "normal map") + " on top of their normals";
    if (color_textures_ > 0)
        words += (words.empty() ? "" : ", ") + counted(color_textures_, "colour texture");
    return words;
}

}  // namespace relief::tools
