// SPDX-License-Identifier: Apache-2.0
/// \file
/// Editing materials: the material model, the images of a material, and the panel.
/// Tests: tests/tools/window/material_panel_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "relief/shade/scene.h"

namespace relief::tools {

enum class MaterialModel { phong, metallic_roughness, unlit };

MaterialModel model_of(const Material& material);

/// Changes the model and keeps the appearance similar. Phong to metallic-roughness: the base color
/// is the diffuse color, metallic is 0, and the roughness is the inverse of
/// phong_from_metallic_roughness (scene_file.h). Metallic-roughness to Phong: the material keeps
/// its Phong values, which the file reader or an earlier change has set.
void set_model(Material& material, MaterialModel model);

/// An image of a material, such as its normal map. Images are decoded when a picture needs them.
struct MapSlot {
    const char* name;  ///< For example "Normal map".
    std::optional<Texture> (*texture)(const Material& material);
    /// Sets the texture, or removes it. A material has either a normal map or a bump map, so
    /// setting one removes the other. The scale and strength of a map stay.
    void (*set)(Material& material, const std::optional<Texture>& texture);
    /// Returns whether the material's model uses this map.
    bool (*is_used)(const Material& material);
};

const std::vector<MapSlot>& map_slots();

/// The name of the image, if there is one.
std::optional<std::string> map_name(const Scene& scene, std::size_t material, const MapSlot& slot);

/// Sets a map to a file. The wrap modes stay; the default is repeat.
/// \throws FileError if the file is not an image
void set_map(Scene& scene, std::size_t material, const MapSlot& slot,
             const std::filesystem::path& file);

}  // namespace relief::tools
