// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/map_slots_test.cpp.
#include "window/map_slots.h"

#include <algorithm>

#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

using MaybeTexture = std::optional<Texture>;

/// A slot that is a member of the material.
template <MaybeTexture Material::*member>
MaybeTexture get(const Material& material) {
    return material.*member;
}
template <MaybeTexture Material::*member>
void put(Material& material, const MaybeTexture& texture) {
    material.*member = texture;
}

bool always(const Material&) {
    return true;
}
bool is_phong(const Material& material) {
    return !material.metallic_roughness && !material.unlit;
}
bool is_metallic(const Material& material) {
    return material.metallic_roughness && !material.unlit;
}
bool is_lit(const Material& material) {
    return !material.unlit;
}

MaybeTexture metallic_texture(const Material& material) {
    return material.metallic_roughness ? material.metallic_roughness->texture : std::nullopt;
}
void set_metallic_texture(Material& material, const MaybeTexture& texture) {
    if (material.metallic_roughness) material.metallic_roughness->texture = texture;
}

MaybeTexture normal_texture(const Material& material) {
    return material.normal_map ? MaybeTexture(material.normal_map->texture) : std::nullopt;
}
void set_normal_texture(Material& material, const MaybeTexture& texture) {
    if (!texture) return material.normal_map.reset();
    if (!material.normal_map) material.normal_map.emplace();
    material.normal_map->texture = *texture;
    material.normal_map->flat.reset();  // Another image may be coded otherwise.
    material.bump_map.reset();
}

MaybeTexture bump_texture(const Material& material) {
    return material.bump_map ? MaybeTexture(material.bump_map->texture) : std::nullopt;
}
void set_bump_texture(Material& material, const MaybeTexture& texture) {
    if (!texture) return material.bump_map.reset();
    if (!material.bump_map) material.bump_map.emplace();
    material.bump_map->texture = *texture;
    material.normal_map.reset();
}

/// Where a file is among the scene's images; it is added where it is not.
std::size_t image_of(Scene& scene, const std::filesystem::path& file) {
    const auto is_it = [&](const ImageSource& image) {
        const auto* path = std::get_if<std::filesystem::path>(&image.source);
        return path != nullptr && *path == file;
    };
    const auto found = std::find_if(scene.images.begin(), scene.images.end(), is_it);
    if (found != scene.images.end()) return static_cast<std::size_t>(found - scene.images.begin());
    scene.images.push_back({.name = file.string(), .source = file, .is_required = true});
    return scene.images.size() - 1;
}

}  // namespace

const std::vector<MapSlot>& map_slots() {
    using M = Material;
    static const std::vector<MapSlot> slots = {
        {"Diffuse map", get<&M::diffuse_texture>, put<&M::diffuse_texture>, always},
        {"Specular map", get<&M::specular_texture>, put<&M::specular_texture>, is_phong},
        {"Metallic and roughness map", metallic_texture, set_metallic_texture, is_metallic},
        {"Normal map", normal_texture, set_normal_texture, is_lit},
        {"Bump map", bump_texture, set_bump_texture, is_lit},
        {"Occlusion map", get<&M::occlusion_texture>, put<&M::occlusion_texture>, is_lit},
        {"Emission map", get<&M::emission_texture>, put<&M::emission_texture>, is_lit},
        {"Opacity map", get<&M::opacity_texture>, put<&M::opacity_texture>, always},
    };
    return slots;
}

std::optional<std::string> map_name(const Scene& scene, std::size_t material, const MapSlot& slot) {
    const MaybeTexture texture = slot.texture(scene.materials[material]);
    if (!texture) return std::nullopt;
    return scene.images[texture->image].name;
}

void set_map(Scene& scene, std::size_t material, const MapSlot& slot,
             const std::filesystem::path& file) {
    read_image_info(file);
    Texture texture = slot.texture(scene.materials[material]).value_or(Texture{});
    texture.image = image_of(scene, file);
    slot.set(scene.materials[material], texture);
}

}  // namespace relief::tools
