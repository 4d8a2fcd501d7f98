// SPDX-License-Identifier: Apache-2.0
/// \file
/// The conventions of engines for normal maps and for packed occlusion, roughness and metalness:
/// --for of bump, convert, mesh and pack. docs/materials.md has the same table.
/// Tests: tests/tools/relief_bake_pack_test.cpp.
#pragma once

#include <array>

#include "relief/mesh/enum_names.h"
#include "relief/mesh/normal_map.h"

namespace relief {

enum class Engine { gltf, godot, unity, unreal };

template <>
inline constexpr auto enum_names<Engine> =
    std::to_array<EnumName<Engine>>({{"gltf", Engine::gltf},
                                     {"godot", Engine::godot},
                                     {"unity", Engine::unity},
                                     {"unreal", Engine::unreal}});

namespace tools {

/// The content of a channel of a packed image.
enum class PackedChannel {
    occlusion,
    roughness,
    smoothness,  ///< 1 - roughness
    metalness,
    zero,
};

}  // namespace tools

template <>
inline constexpr auto enum_names<tools::PackedChannel> =
    std::to_array<EnumName<tools::PackedChannel>>({{"occlusion", tools::PackedChannel::occlusion},
                                                   {"roughness", tools::PackedChannel::roughness},
                                                   {"smoothness", tools::PackedChannel::smoothness},
                                                   {"metalness", tools::PackedChannel::metalness},
                                                   {"nothing", tools::PackedChannel::zero}});

namespace tools {

struct EngineRules {
    Engine engine;
    Green green;              ///< Of normal maps.
    int bits;                 ///< Of normal maps in PNG and TIFF.
    const char* normal_name;  ///< The usual end of the file name.
    const char* packed_name;
    const char* color_name;
    const char* emission_name;
    const char* height_name;
    int channels;  ///< Of the packed image.
    std::array<PackedChannel, 4> packed;
};

inline constexpr std::array engine_rules = {
    EngineRules{Engine::gltf,
                Green::up,
                8,
                "_normal",
                "_orm",
                "_baseColor",
                "_emissive",
                "_height",
                3,
                {PackedChannel::occlusion, PackedChannel::roughness, PackedChannel::metalness,
                 PackedChannel::zero}},
    EngineRules{Engine::godot,
                Green::up,
                8,
                "_normal",
                "_orm",
                "_albedo",
                "_emission",
                "_height",
                3,
                {PackedChannel::occlusion, PackedChannel::roughness, PackedChannel::metalness,
                 PackedChannel::zero}},
    EngineRules{Engine::unity,
                Green::up,
                8,
                "_Normal",
                "_MaskMap",
                "_BaseMap",
                "_Emission",
                "_Height",
                4,
                {PackedChannel::metalness, PackedChannel::occlusion, PackedChannel::zero,
                 PackedChannel::smoothness}},
    EngineRules{Engine::unreal,
                Green::down,
                8,
                "_N",
                "_ORM",
                "_D",
                "_E",
                "_H",
                3,
                {PackedChannel::occlusion, PackedChannel::roughness, PackedChannel::metalness,
                 PackedChannel::zero}},
};

constexpr const EngineRules& rules_of(Engine engine) {
    return engine_rules[static_cast<std::size_t>(engine)];
}

}  // namespace tools
}  // namespace relief
