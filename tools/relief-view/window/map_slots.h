// SPDX-License-Identifier: Apache-2.0
/// \file
/// The places that a material has for images, by name, and putting files there. No OpenGL: an image
/// is decoded when a picture needs it. Tests: tests/tools/window/map_slots_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "relief/shade/scene.h"

namespace relief::tools {

struct MapSlot {
    const char* name;  ///< "Normal map"
    std::optional<Texture> (*texture)(const Material& material);
    /// Nothing clears it. A normal map clears a bump map, and the other way round: a material has
    /// one of them. What else the map has (its scale, its strength) stays or is as usual.
    void (*set)(Material& material, const std::optional<Texture>& texture);
    /// Whether the material's model has a use for it.
    bool (*is_used)(const Material& material);
};

const std::vector<MapSlot>& map_slots();

/// What the slot shows: the image's name, or nothing.
std::optional<std::string> map_name(const Scene& scene, std::size_t material, const MapSlot& slot);

/// Puts a file there, wrapped as what was there before. The default is repeated.
/// \throws FileError if it is no image
void set_map(Scene& scene, std::size_t material, const MapSlot& slot,
             const std::filesystem::path& file);

}  // namespace relief::tools
