// SPDX-License-Identifier: Apache-2.0
// A material's textures by the samplers that shaders have for them. A mesh without texture
// coordinates shows none. Tests: tests/shade/render/renderer_test.cpp.
#include "render/material_textures.h"

#include <algorithm>
#include <array>

namespace relief {

namespace {

/// One of a material's textures: where it is bound, how it is read, and whether features sample it.
struct TextureRow {
    TextureUnit unit;
    ImageUse use;
    bool (*sampled)(const Features& f);
    const Texture* (*texture)(const Material& m);
};

template <auto Member>
const Texture* optional_texture(const Material& m) {
    return m.*Member ? &*(m.*Member) : nullptr;
}

const std::array<TextureRow, material_unit_count>& texture_rows() {
    using F = const Features&;
    using M = const Material&;
    static const std::array<TextureRow, material_unit_count> all{{
        {TextureUnit::diffuse_texture, ImageUse::color, [](F f) { return f.diffuse_texture; },
         optional_texture<&Material::diffuse_texture>},
        {TextureUnit::specular_texture, ImageUse::color, [](F f) { return f.specular_texture; },
         optional_texture<&Material::specular_texture>},
        {TextureUnit::emission_texture, ImageUse::color, [](F f) { return f.emission_texture; },
         optional_texture<&Material::emission_texture>},
        {TextureUnit::occlusion_texture, ImageUse::data, [](F f) { return f.occlusion_texture; },
         optional_texture<&Material::occlusion_texture>},
        {TextureUnit::opacity_texture, ImageUse::data, [](F f) { return f.opacity_texture; },
         optional_texture<&Material::opacity_texture>},
        {TextureUnit::metallic_roughness_texture, ImageUse::data,
         [](F f) { return f.metallic_roughness_texture; },
         [](M m) -> const Texture* {
             const auto& model = m.metallic_roughness;
             return model && model->texture ? &*model->texture : nullptr;
         }},
        {TextureUnit::normal_texture, ImageUse::data,
         [](F f) {
             return f.detail == NormalDetail::normal_map ||
                    f.detail == NormalDetail::object_normal_map;
         },
         [](M m) { return m.normal_map ? &m.normal_map->texture : nullptr; }},
        {TextureUnit::bump_texture, ImageUse::data,
         [](F f) { return f.detail == NormalDetail::bump_map; },
         [](M m) { return m.bump_map ? &m.bump_map->texture : nullptr; }},
    }};
    return all;
}

}  // namespace

std::vector<UsedTexture> used_textures(const Features& features, const Material& material,
                                       const Mesh& mesh) {
    std::vector<UsedTexture> used;
    for (const TextureRow& row : texture_rows()) {
        if (!row.sampled(features)) continue;
        const Texture* texture = mesh.texcoords.empty() ? nullptr : row.texture(material);
        used.push_back({row.unit, texture, row.use});
    }
    return used;
}

bool has_textures(const Material& material) {
    return std::any_of(texture_rows().begin(), texture_rows().end(),
                       [&](const TextureRow& row) { return row.texture(material) != nullptr; });
}

}  // namespace relief
