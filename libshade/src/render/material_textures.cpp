// SPDX-License-Identifier: Apache-2.0
// A material's textures by the samplers that shaders have for them. A mesh without texture
// coordinates shows none. Tests: tests/shade/render/renderer_test.cpp.
#include "render/material_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "relief/shade/image_source.h"
#include "relief/shade/labels.h"

namespace relief {

namespace {

const char* const unreadable_reason = "its image cannot be read";

/// One of a material's textures: where it is bound, how it is read, and whether features sample it.
struct TextureRow {
    TextureUnit unit;
    ImageUse use;
    bool (*sampled)(const Features& f);
    const Texture* (*texture)(const Material& m);
    void (*remove)(Material& m);
};

template <auto Member>
const Texture* optional_texture(const Material& m) {
    return m.*Member ? &*(m.*Member) : nullptr;
}
template <auto Member>
void remove_optional(Material& m) {
    (m.*Member).reset();
}

const std::array<TextureRow, material_unit_count>& texture_rows() {
    using F = const Features&;
    using M = const Material&;
    static const std::array<TextureRow, material_unit_count> all{{
        {TextureUnit::diffuse_texture, ImageUse::color, [](F f) { return f.diffuse_texture; },
         optional_texture<&Material::diffuse_texture>, remove_optional<&Material::diffuse_texture>},
        {TextureUnit::specular_texture, ImageUse::color, [](F f) { return f.specular_texture; },
         optional_texture<&Material::specular_texture>,
         remove_optional<&Material::specular_texture>},
        {TextureUnit::emission_texture, ImageUse::color, [](F f) { return f.emission_texture; },
         optional_texture<&Material::emission_texture>,
         [](Material& m) {
             m.emission_texture.reset();
             m.emission = glm::vec3(0.0F);
         }},
        {TextureUnit::occlusion_texture, ImageUse::data, [](F f) { return f.occlusion_texture; },
         optional_texture<&Material::occlusion_texture>,
         remove_optional<&Material::occlusion_texture>},
        {TextureUnit::opacity_texture, ImageUse::data, [](F f) { return f.opacity_texture; },
         optional_texture<&Material::opacity_texture>, remove_optional<&Material::opacity_texture>},
        {TextureUnit::metallic_roughness_texture, ImageUse::data,
         [](F f) { return f.metallic_roughness_texture; },
         [](M m) -> const Texture* {
             const auto& model = m.metallic_roughness;
             return model && model->texture ? &*model->texture : nullptr;
         },
         [](Material& m) { m.metallic_roughness->texture.reset(); }},
        {TextureUnit::normal_texture, ImageUse::data,
         [](F f) {
             return f.detail == NormalDetail::normal_map ||
                    f.detail == NormalDetail::object_normal_map;
         },
         [](M m) { return m.normal_map ? &m.normal_map->texture : nullptr; },
         remove_optional<&Material::normal_map>},
        {TextureUnit::bump_texture, ImageUse::data,
         [](F f) { return f.detail == NormalDetail::bump_map; },
         [](M m) { return m.bump_map ? &m.bump_map->texture : nullptr; },
         remove_optional<&Material::bump_map>},
    }};
    return all;
}

/// The effect that a texture makes, by its name in effects().
const char* effect_of(TextureUnit unit, const Features& features) {
    switch (unit) {
        case TextureUnit::diffuse_texture:
            return "diffuse texture";
        case TextureUnit::specular_texture:
            return "specular texture";
        case TextureUnit::emission_texture:
            return "emission texture";
        case TextureUnit::occlusion_texture:
            return "occlusion texture";
        case TextureUnit::opacity_texture:
            return "opacity texture";
        case TextureUnit::metallic_roughness_texture:
            return "metallic-roughness texture";
        case TextureUnit::bump_texture:
            return "bump map";
        default:
            return features.detail == NormalDetail::object_normal_map ? "object-space normal map"
                                                                      : "normal map";
    }
}

void leave_out(Features& features, TextureUnit unit) {
    const std::string_view name = effect_of(unit, features);
    const auto effect = std::find_if(effects().begin(), effects().end(),
                                     [&](const Effect& one) { return one.name == name; });
    effect->set(features, false);
    if (unit == TextureUnit::emission_texture) features.emission = false;
}

void report_left_out(const Scene& scene, std::optional<std::uint32_t> material, const char* effect,
                     const std::pair<const std::size_t, std::string>& image, Report& report) {
    report.add(fmt::format("unreadable {} of {}", effect, material_label(scene, material)), "image",
               image.first,
               "drawn without it: " + with_origin(scene.images[image.first], image.second));
}

/// Turns off the reasons of effects that the draw does not have any more.
void correct_reasons(DrawPlan& draw, const Features& planned) {
    for (const Effect& effect : effects()) {
        if (!effect.on(planned) || effect.on(draw.features)) continue;
        for (EffectReason& reason : draw.reasons) {
            if (reason.effect == effect.name) reason = {effect.name, false, unreadable_reason};
        }
    }
    if (!draw.needs_tangents || draw.features.detail != NormalDetail::none) return;
    draw.needs_tangents = false;
    for (EffectReason& reason : draw.reasons) {
        if (reason.effect == "computed tangents")
            reason = {reason.effect, false, unreadable_reason};
    }
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

void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        FramePlan& plan, Report& report) {
    std::set<std::pair<std::optional<std::uint32_t>, TextureUnit>> reported;
    for (DrawPlan& draw : plan.draws) {
        const std::optional<std::uint32_t> number = draw.range.material;
        const Material& material = number ? scene.materials[*number] : default_material();
        const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
        const Features planned = draw.features;
        for (const UsedTexture& used : used_textures(planned, material, mesh)) {
            const auto entry =
                used.texture == nullptr ? unreadable.end() : unreadable.find(used.texture->image);
            if (entry == unreadable.end()) continue;
            leave_out(draw.features, used.unit);
            if (!reported.emplace(number, used.unit).second) continue;
            report_left_out(scene, number, effect_of(used.unit, planned), *entry, report);
        }
        if (draw.features == planned) continue;
        draw.features = canonical(draw.features);
        correct_reasons(draw, planned);
    }
}

void leave_out_textures(const Scene& scene, const std::map<std::size_t, std::string>& unreadable,
                        std::uint32_t number, Material& material, Report& report) {
    Features features;
    if (material.normal_map && material.normal_map->space == NormalSpace::object)
        features.detail = NormalDetail::object_normal_map;
    for (const TextureRow& row : texture_rows()) {
        const Texture* const texture = row.texture(material);
        const auto entry = texture == nullptr ? unreadable.end() : unreadable.find(texture->image);
        if (entry == unreadable.end()) continue;
        report_left_out(scene, number, effect_of(row.unit, features), *entry, report);
        row.remove(material);
    }
}

bool has_textures(const Material& material) {
    return std::any_of(texture_rows().begin(), texture_rows().end(),
                       [&](const TextureRow& row) { return row.texture(material) != nullptr; });
}

}  // namespace relief
