// SPDX-License-Identifier: Apache-2.0
// Access to the textures of a material by slot. Tests: tests/mesh/io/gltf/gltf_view_test.cpp.
#include "relief/mesh/material.h"

#include <type_traits>

namespace relief {
namespace {

/// Returns the texture of a member: the member itself, or that of a map.
template <typename Value>
auto& texture_of_member(Value& value) {
    if constexpr (std::is_same_v<std::remove_const_t<Value>, Texture>) {
        return value;
    } else {
        return value.texture;
    }
}

/// Calls visit(optional) with the member of a slot, unless the material lacks glTF's model, or the
/// height map that has the member.
template <typename AnyMaterial, typename Visit>
void visit_member(AnyMaterial& material, TextureSlot slot, const Visit& visit) {
    std::visit(
        [&]<typename Value, typename Owner>(Value Owner::*member) {
            if constexpr (std::is_same_v<Owner, Material>) {
                visit(material.*member);
            } else if constexpr (std::is_same_v<Owner, ReliefMap>) {
                if (material.height_map) visit((*material.height_map).*member);
            } else if (material.metallic_roughness) {
                visit((*material.metallic_roughness).*member);
            }
        },
        slot_info(slot).member);
}

template <typename AnyMaterial>
auto find_in(AnyMaterial& material, TextureSlot slot) {
    decltype(&texture_of_member(*material.diffuse_texture)) texture = nullptr;
    visit_member(material, slot, [&](auto& member) {
        if (member) texture = &texture_of_member(*member);
    });
    return texture;
}

}  // namespace

Texture* find_texture(Material& material, TextureSlot slot) {
    return find_in(material, slot);
}

const Texture* find_texture(const Material& material, TextureSlot slot) {
    return find_in(material, slot);
}

void set_texture(Material& material, TextureSlot slot, const Texture& texture) {
    visit_member(material, slot, [&](auto& member) {
        if (!member) member.emplace();
        texture_of_member(*member) = texture;
    });
}

void remove_texture(Material& material, TextureSlot slot) {
    visit_member(material, slot, [](auto& member) { member.reset(); });
}

}  // namespace relief
