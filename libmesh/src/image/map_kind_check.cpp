// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/map_kind_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace relief {
namespace {

constexpr std::int64_t min_judged_texels = 64;

bool holds_normals(MapKind kind) {
    return kind == MapKind::normal || kind == MapKind::object_normal ||
           kind == MapKind::world_normal;
}

bool is_accepted(std::span<const MapKind> accepted, MapKind kind) {
    return std::find(accepted.begin(), accepted.end(), kind) != accepted.end();
}

/// The kind that an image with this content seems to have.
WrongMapKind seeming_kind(MapContent content) {
    switch (content) {
        case MapContent::gray:
            return {MapKind::height,
                    "is gray, like a height map or a mask, so it is not a normal map"};
        case MapContent::other:
            return {std::nullopt, "is not a normal map: its texels are colors, or several masks"};
        case MapContent::object_normals:
            return {MapKind::object_normal, "seems to be a normal map in object space"};
        default:
            return {MapKind::normal, "seems to be a normal map"};
    }
}

}  // namespace

std::vector<MapKind> accepted_kinds(TextureSlot slot) {
    switch (slot) {
        case TextureSlot::normal:
            return {MapKind::normal, MapKind::object_normal};
        case TextureSlot::clearcoat_normal:
            return {MapKind::normal};
        case TextureSlot::bump:
        case TextureSlot::height:
            return {MapKind::height};
        case TextureSlot::base_color:
        case TextureSlot::emission:
            return {MapKind::color};
        default:
            return {};
    }
}

std::vector<MapKind> drawn_kinds(const Material& material, TextureSlot slot) {
    if (slot != TextureSlot::normal || !material.normal_map) return accepted_kinds(slot);
    const bool is_object = material.normal_map->space == NormalSpace::object;
    return {is_object ? MapKind::object_normal : MapKind::normal};
}

std::optional<WrongMapKind> stated_wrong_kind(std::span<const MapKind> accepted,
                                              const MapDescription& stated) {
    if (!stated.kind || accepted.empty() || is_accepted(accepted, *stated.kind))
        return std::nullopt;
    return WrongMapKind{
        stated.kind, fmt::format("is {}, as its metadata say", map_kind_info(*stated.kind).phrase)};
}

bool is_judged_by_texels(std::span<const MapKind> accepted) {
    return !accepted.empty() &&
           (holds_normals(accepted.front()) || accepted.front() == MapKind::height);
}

std::optional<MapContent> unstated_content(const ImageView& map, const MapDescription& stated) {
    if (stated.kind || std::int64_t{map.width} * map.height < min_judged_texels)
        return std::nullopt;
    return judged_content(map, stated.flat.value_or(FlatCode::half));
}

std::optional<WrongMapKind> judged_wrong_kind(std::span<const MapKind> accepted,
                                              MapContent content) {
    if (!is_judged_by_texels(accepted)) return std::nullopt;
    WrongMapKind seeming = seeming_kind(content);
    if (seeming.kind && is_accepted(accepted, *seeming.kind)) return std::nullopt;
    // Colors may be heights: their mean or their red channel is read.
    const bool are_normals = seeming.kind && holds_normals(*seeming.kind);
    if (accepted.front() == MapKind::height && !are_normals) return std::nullopt;
    return seeming;
}

std::string drawn_as(MapKind kind) {
    return fmt::format("is drawn as {}", map_kind_info(kind).phrase);
}

void report_drawn_kind(const WrongMapKind& wrong, TextureSlot slot, MapKind drawn,
                       std::size_t material, Report& report) {
    report.add(fmt::format("{} that {}", slot_info(slot).effect, wrong.problem), "material",
               material, drawn_as(drawn));
}

}  // namespace relief
