// SPDX-License-Identifier: Apache-2.0
// The groups of the rows of a material. Tests: tests/tools/window/material_panel_test.cpp.
#include <algorithm>
#include <array>

#include "relief/mesh/material.h"
#include "window/edit_panels.h"

namespace relief::tools {

namespace {

constexpr glm::vec3 black(0.0F);

/// A group of an extension whose title or effect does not follow from the tables.
struct ExtensionRule {
    std::string_view name;
    const char* title;
    bool (*has_effect)(const MetallicRoughness&);
};
constexpr std::array extension_rules{
    ExtensionRule{"KHR_materials_ior", "Refraction",
                  [](const MetallicRoughness& m) {
                      return m.refractive_index != MetallicRoughness{}.refractive_index;
                  }},
    ExtensionRule{"KHR_materials_specular", "Specular",
                  [](const MetallicRoughness& m) {
                      return m.specular != 1.0F || m.specular_color != glm::vec3(1.0F) ||
                             m.specular_texture || m.specular_color_texture;
                  }},
    ExtensionRule{"KHR_materials_clearcoat", "Clearcoat",
                  [](const MetallicRoughness& m) { return m.clearcoat != 0.0F; }},
    ExtensionRule{"KHR_materials_sheen", "Sheen",
                  [](const MetallicRoughness& m) { return m.sheen_color != black; }},
    ExtensionRule{"KHR_materials_anisotropy", "Anisotropy",
                  [](const MetallicRoughness& m) { return m.anisotropy != 0.0F; }},
    ExtensionRule{"KHR_materials_iridescence", "Iridescence",
                  [](const MetallicRoughness& m) { return m.iridescence != 0.0F; }},
    ExtensionRule{"KHR_materials_transmission", "Transmission",
                  [](const MetallicRoughness& m) { return m.transmission != 0.0F; }},
    // A volume shows only where light passes.
    ExtensionRule{
        "KHR_materials_volume", "Volume",
        [](const MetallicRoughness& m) { return m.thickness != 0.0F && m.transmission != 0.0F; }},
    ExtensionRule{"KHR_materials_dispersion", "Dispersion",
                  [](const MetallicRoughness& m) {
                      return m.dispersion != 0.0F && m.thickness != 0.0F && m.transmission != 0.0F;
                  }},
};

/// The title of an extension without a rule: its name without the prefix.
std::string title_of(std::string_view extension) {
    constexpr std::string_view prefix = "KHR_materials_";
    if (extension.starts_with(prefix)) extension.remove_prefix(prefix.size());
    return capitalized(spaced(std::string(extension)));
}

MaterialGroup extension_group(const MetallicRoughness& model, std::string_view extension) {
    MaterialGroup group{MaterialTopic::extension, title_of(extension), extension, true, {}};
    for (const ExtensionRule& rule : extension_rules) {
        if (rule.name != extension) continue;
        group.title = rule.title;
        group.has_effect = rule.has_effect(model);
    }
    for (const TextureSlotInfo& info : texture_slots) {
        if (gltf_extension_of(info.gltf) == extension) group.slots.push_back(info.slot);
    }
    return group;
}

/// The extensions of the fields, in their order.
std::vector<std::string_view> field_extensions() {
    std::vector<std::string_view> names;
    for_each_field<MetallicRoughness>([&](const auto& field) {
        const std::string_view name = gltf_extension_of(field.gltf);
        if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
    });
    return names;
}

}  // namespace

std::string_view gltf_extension_of(std::string_view gltf) {
    constexpr std::string_view prefix = "extensions/";
    if (!gltf.starts_with(prefix)) return {};
    gltf.remove_prefix(prefix.size());
    return gltf.substr(0, gltf.find('/'));
}

std::vector<MaterialGroup> material_groups(const Material& material) {
    using Topic = MaterialTopic;
    using Slot = TextureSlot;
    std::vector<MaterialGroup> groups;
    const auto add = [&](Topic topic, const char* title, bool has_effect, std::vector<Slot> slots) {
        groups.push_back({topic, title, {}, has_effect, std::move(slots)});
    };
    const bool is_metallic = material.metallic_roughness && !material.unlit;
    add(Topic::base, "", true,
        is_metallic ? std::vector{Slot::base_color, Slot::metallic_roughness}
                    : std::vector{Slot::base_color});
    if (!material.unlit) {
        if (!is_metallic) {
            add(Topic::highlights, "Highlights", material.specular != black, {Slot::specular});
            add(Topic::reflection, "Reflection",
                material.reflectivity != black || material.transmission != 0.0F ||
                    material.environment_tint,
                {});
        }
        std::vector<Slot> maps{Slot::normal, Slot::bump, Slot::height};
        if (material.height_map) maps.push_back(Slot::cones);
        add(Topic::relief, "Relief",
            material.normal_map || material.bump_map || material.height_map, std::move(maps));
        add(Topic::occlusion, "Occlusion", material.occlusion_texture.has_value(),
            {Slot::occlusion});
        add(Topic::emission, "Emission", material.emission != black, {Slot::emission});
    }
    add(Topic::transparency, "Transparency", material.alpha_mode != AlphaMode::opaque,
        {Slot::opacity});
    if (!is_metallic) return groups;
    for (const std::string_view extension : field_extensions())
        groups.push_back(extension_group(*material.metallic_roughness, extension));
    return groups;
}

}  // namespace relief::tools
