// SPDX-License-Identifier: Apache-2.0
// Writes the maps of an asset for engines. Tests: tests/make/make_engine_test.cpp.
#include "make_engine.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {
namespace {

/// Engines that read the maps of glTF files in their convention need no other files.
bool has_map_files(Engine engine) {
    return engine == Engine::unity || engine == Engine::unreal;
}

/// "rock_N.png" for rock.glb.
std::filesystem::path map_file(const std::filesystem::path& output, const std::string& suffix) {
    return output.parent_path() / (output.stem().string() + suffix + ".png");
}

std::filesystem::path layer_file(Engine engine, const std::filesystem::path& output,
                                 LayerKind kind) {
    return map_file(output, kind == LayerKind::height ? rules_of(engine).height_name
                                                      : "_" + make::layer_name(kind));
}

/// Returns the normal map with the direction of green that an engine reads. The code of zero is
/// half of the largest code, so that the opposite of each code exists.
Image normal_map_for(const Image& map, Green green) {
    Image result = map;
    if (green == Green::up) return result;
    std::visit(
        [](auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            for (std::size_t i = 1; i < samples.size(); i += 3)
                samples[i] = static_cast<Sample>(std::numeric_limits<Sample>::max() - samples[i]);
        },
        result.samples);
    return result;
}

std::uint8_t code_of(float share) {
    return static_cast<std::uint8_t>(std::floor(std::clamp(share, 0.0F, 1.0F) * 255.0F + 0.5F));
}

/// A channel of a map, or one value.
struct ChannelSource {
    const Image* image = nullptr;
    int channel = 0;
    std::uint8_t value = 255;

    [[nodiscard]] std::uint8_t at(std::size_t texel) const {
        if (image == nullptr) return value;
        const auto channels = static_cast<std::size_t>(image->channels);
        return image->as<std::uint8_t>()[texel * channels + static_cast<std::size_t>(channel)];
    }
};

ChannelSource source_of(PackedChannel channel, const make::Asset& asset) {
    const Image* surface = asset.surface_map ? &*asset.surface_map : nullptr;
    const MetallicRoughness& factors = *asset.material.metallic_roughness;
    switch (channel) {
        case PackedChannel::occlusion:
            return {surface != nullptr ? surface : &*asset.occlusion_map, 0};
        case PackedChannel::roughness:
        case PackedChannel::smoothness:
            return {surface, 1, code_of(factors.roughness)};
        case PackedChannel::metalness:
            return {surface, 2, code_of(factors.metallic)};
        case PackedChannel::zero:
            break;
    }
    return {nullptr, 0, 0};
}

/// Packs occlusion, roughness and metalness. Factors apply where there is no map.
Image packed_map_for(const make::Asset& asset, const EngineRules& rules) {
    const Image& map = asset.surface_map ? *asset.surface_map : *asset.occlusion_map;
    Image packed;
    packed.width = map.width;
    packed.height = map.height;
    packed.channels = rules.channels;
    std::vector<std::uint8_t> samples(packed.sample_count());
    const auto channels = static_cast<std::size_t>(rules.channels);
    for (std::size_t channel = 0; channel < channels; ++channel) {
        const ChannelSource source = source_of(rules.packed[channel], asset);
        const bool is_inverse = rules.packed[channel] == PackedChannel::smoothness;
        for (std::size_t texel = 0; texel < samples.size() / channels; ++texel) {
            const std::uint8_t code = source.at(texel);
            samples[channels * texel + channel] =
                is_inverse ? static_cast<std::uint8_t>(255 - code) : code;
        }
    }
    packed.samples = std::move(samples);
    return packed;
}

}  // namespace

std::vector<std::filesystem::path> map_files_of(Engine engine, const make::AssetOptions& options,
                                                const std::filesystem::path& output) {
    std::vector<std::filesystem::path> files;
    const EngineRules& rules = rules_of(engine);
    if (has_map_files(engine)) {
        for (const char* name :
             {rules.normal_name, rules.packed_name, rules.color_name, rules.emission_name})
            files.push_back(map_file(output, name));
    }
    for (const LayerKind kind : options.layers)
        files.push_back(layer_file(engine, output, kind));
    return files;
}

std::vector<std::filesystem::path> write_map_files(Engine engine,
                                                   const std::filesystem::path& output,
                                                   const make::Asset& asset) {
    std::vector<std::filesystem::path> files;
    const auto write = [&](const std::filesystem::path& file, const Image& image,
                           const std::map<std::string, std::string>& metadata) {
        write_image(file, image, metadata);
        files.push_back(file);
    };
    const EngineRules& rules = rules_of(engine);
    const bool has_files = has_map_files(engine);
    if (has_files) {
        NormalMapFormat format;
        format.bits = asset.normal_map.bits();
        format.green = rules.green;
        write(map_file(output, rules.normal_name), normal_map_for(asset.normal_map, rules.green),
              normal_map_metadata(format));
    }
    if (has_files && (asset.occlusion_map || asset.surface_map)) {
        MapDescription packed{.kind = MapKind::packed};
        packed.detail = enum_name(engine);
        packed.color_space = ColorSpace::data;
        write(map_file(output, rules.packed_name), packed_map_for(asset, rules),
              write_description(packed, 8));
    }
    for (const make::AssetMap& map : make::maps_of(asset)) {
        const bool is_color = map.image == (asset.color_map ? &*asset.color_map : nullptr);
        const bool is_emission = map.image == (asset.emission_map ? &*asset.emission_map : nullptr);
        if (has_files && (is_color || is_emission))
            write(map_file(output, is_color ? rules.color_name : rules.emission_name), *map.image,
                  map.metadata);
    }
    const std::vector<make::AssetMap> maps = make::maps_of(asset);
    for (const make::AssetLayer& layer : asset.layers) {
        const auto map = std::ranges::find(maps, &layer.image, &make::AssetMap::image);
        const std::filesystem::path file = layer_file(engine, output, layer.coding.kind);
        if (layer.coding.kind == LayerKind::bent_normal) {
            LayerCoding coding = layer.coding;
            coding.normal_format.green = rules.green;
            write(file, normal_map_for(layer.image, rules.green), layer_metadata(coding));
        } else {
            write(file, layer.image, map->metadata);
        }
    }
    return files;
}

}  // namespace relief::tools
