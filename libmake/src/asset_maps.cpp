// SPDX-License-Identifier: Apache-2.0
// The table of the maps of an asset: names, places in the material and metadata of files.
// Tests: tests/make/asset_maps_test.cpp.
#include <utility>

#include "relief/make/asset.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"

namespace relief::make {
namespace {

std::map<std::string, std::string> metadata_of_normals(int bits) {
    NormalMapFormat format;
    format.bits = bits;
    return normal_map_metadata(format);
}

}  // namespace

std::string layer_name(LayerKind kind) {
    switch (kind) {
        case LayerKind::height:
            return "height";
        case LayerKind::occlusion:
            return "occlusion";
        case LayerKind::curvature:
            return "curvature";
        case LayerKind::position:
            return "position";
        case LayerKind::color:
            return "color";
        case LayerKind::surface:
            return "orm";
        case LayerKind::bent_normal:
            return "bent";
        case LayerKind::thickness:
            return "thickness";
        case LayerKind::id:
            return "ids";
        case LayerKind::emission:
            break;
    }
    return "emission";
}

std::vector<AssetMap> maps_of(const Asset& asset) {
    std::vector<AssetMap> maps;
    const auto add = [&](LayerKind kind, const char* content, const std::optional<Image>& image,
                         std::vector<TextureSlot> slots, const LayerCoding& coding,
                         std::optional<AlphaContent> alpha = {}) {
        if (!image) return;
        maps.push_back(
            {layer_name(kind), content, &*image, std::move(slots), layer_metadata(coding, alpha)});
    };
    const auto of_8_bits = [](LayerKind kind, double range = 1.0) {
        return LayerCoding{kind, 8, range};
    };
    maps.push_back({"normal",
                    "normals",
                    &asset.normal_map,
                    {TextureSlot::normal},
                    metadata_of_normals(asset.normal_map.bits())});
    add(LayerKind::occlusion, "occlusion", asset.occlusion_map, {TextureSlot::occlusion},
        of_8_bits(LayerKind::occlusion));
    const bool has_opacity = asset.color_map && asset.color_map->channels == 4;
    add(LayerKind::color, "colors", asset.color_map, {TextureSlot::base_color},
        of_8_bits(LayerKind::color),
        has_opacity ? std::optional(AlphaContent::opacity) : std::nullopt);
    const bool has_occlusion = asset.surface_has_occlusion;
    add(LayerKind::surface,
        has_occlusion ? "occlusion, roughness, metalness" : "roughness, metalness",
        asset.surface_map,
        has_occlusion ? std::vector{TextureSlot::metallic_roughness, TextureSlot::occlusion}
                      : std::vector{TextureSlot::metallic_roughness},
        of_8_bits(LayerKind::surface));
    add(LayerKind::emission, "emission", asset.emission_map, {TextureSlot::emission},
        of_8_bits(LayerKind::emission, static_cast<double>(asset.material.emission_strength)));
    for (const AssetLayer& layer : asset.layers) {
        maps.push_back({layer_name(layer.coding.kind),
                        std::string(enum_name(layer.coding.kind)),
                        &layer.image,
                        {},
                        layer_metadata(layer.coding)});
    }
    return maps;
}

}  // namespace relief::make
