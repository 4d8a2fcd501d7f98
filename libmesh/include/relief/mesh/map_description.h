// SPDX-License-Identifier: Apache-2.0
/// \file
/// The metadata of a map: the kind of its values, its conventions, its color space and the
/// meaning of its alpha. It is stored as text entries of image and texture files (image_file.h,
/// texture_file.h). Tests: tests/mesh/image/map_description_test.cpp.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"

namespace RELIEF_API relief {

/// The kind of the values of a map.
enum class MapKind {
    normal,         ///< Normals in tangent space.
    object_normal,  ///< Normals in the object space of one mesh.
    world_normal,   ///< Normals in world space.
    slope_moments,
    height,
    occlusion,
    curvature,
    position,
    color,
    roughness,
    packed,  ///< Occlusion, roughness and metalness in the channels of one image.
    error,   ///< The errors of another map.
    metalness,
    emission,
    bent_normal,  ///< The mean unoccluded directions.
    thickness,
    id,  ///< Flat colors of materials or parts.
};

template <>
inline constexpr auto enum_names<MapKind> =
    std::to_array<EnumName<MapKind>>({{"normal", MapKind::normal},
                                      {"object-normal", MapKind::object_normal},
                                      {"world-normal", MapKind::world_normal},
                                      {"slope-moments", MapKind::slope_moments},
                                      {"height", MapKind::height},
                                      {"occlusion", MapKind::occlusion},
                                      {"curvature", MapKind::curvature},
                                      {"position", MapKind::position},
                                      {"color", MapKind::color},
                                      {"roughness", MapKind::roughness},
                                      {"packed", MapKind::packed},
                                      {"error", MapKind::error},
                                      {"metalness", MapKind::metalness},
                                      {"emission", MapKind::emission},
                                      {"bent-normal", MapKind::bent_normal},
                                      {"thickness", MapKind::thickness},
                                      {"id", MapKind::id}});

/// The texts for a kind.
struct MapKindInfo {
    MapKind kind;
    std::string_view content;  ///< The entry of files: "normal map, tangent space".
    std::string_view phrase;   ///< In messages: "a normal map in tangent space".
};

/// The texts for a kind.
const MapKindInfo& map_kind_info(MapKind kind);

/// The content of the fourth channel, or of the second channel beside gray.
enum class AlphaContent {
    coverage,  ///< 1 in texels that belong to the surface.
    opacity,   ///< The opacity of a color.
    height,    ///< From 0 to 1.
    length,    ///< The length of an averaged normal.
};

template <>
inline constexpr auto enum_names<AlphaContent> =
    std::to_array<EnumName<AlphaContent>>({{"coverage", AlphaContent::coverage},
                                           {"opacity", AlphaContent::opacity},
                                           {"height", AlphaContent::height},
                                           {"length", AlphaContent::length}});

/// The metadata of a map. An absent entry is not stated.
struct MapDescription {
    std::optional<MapKind> kind{};
    /// After a comma in the entry of the kind: the engine of a packed map, the space of bent
    /// normals.
    std::string detail{};
    std::optional<Green> green{};    ///< Of normals in tangent space, and of slopes.
    std::optional<FlatCode> flat{};  ///< The code of zero of normals. None for float samples.
    /// Red and green hold x and y, and z must be computed.
    bool xy_only = false;
    std::optional<ColorSpace> color_space{};
    std::optional<AlphaContent> alpha{};
};

/// Reads the description from the text entries of a file. Entries with unknown values are ignored.
MapDescription read_description(const std::map<std::string, std::string>& entries);

/// Returns the text entries of a description:
///
/// | key | value |
/// |---|---|
/// | relief:content | MapKindInfo::content, a comma and the detail |
/// | relief:green | "up" or "down" |
/// | relief:flat | the code of zero: "128", "127.5", "32768", "32767.5", or "0.5" for float |
/// | relief:channels | "xy" |
/// | relief:color-space | "data", "linear" or "sRGB" |
/// | relief:alpha | the name of the content of alpha |
///
/// \param bits  of the samples, for the code of zero: 8, 16 or 32
std::map<std::string, std::string> write_description(const MapDescription& description, int bits);

/// The keys of these entries.
std::span<const std::string_view> description_keys();

}  // namespace relief
