// SPDX-License-Identifier: Apache-2.0
// Descriptions of maps: one table of kinds, and one of the text entries with their reader and
// writer.
#include "relief/mesh/map_description.h"

#include <algorithm>
#include <array>

namespace relief {
namespace {

constexpr std::array all_kinds = {
    MapKindInfo{MapKind::normal, "normal map, tangent space", "a normal map in tangent space"},
    MapKindInfo{MapKind::object_normal, "normal map, object space", "a normal map in object space"},
    MapKindInfo{MapKind::world_normal, "normal map, world space", "a normal map in world space"},
    MapKindInfo{MapKind::slope_moments, "slope moments", "a map of slope moments"},
    MapKindInfo{MapKind::height, "height map", "a height map"},
    MapKindInfo{MapKind::occlusion, "ambient occlusion", "a map of ambient occlusion"},
    MapKindInfo{MapKind::curvature, "curvature", "a map of curvature"},
    MapKindInfo{MapKind::position, "positions", "a map of positions"},
    MapKindInfo{MapKind::color, "colors", "a color map"},
    MapKindInfo{MapKind::roughness, "roughness", "a roughness map"},
    MapKindInfo{MapKind::packed, "packed maps", "a map of occlusion, roughness and metalness"},
    MapKindInfo{MapKind::error, "errors of normals", "a map of errors"},
    MapKindInfo{MapKind::metalness, "metalness", "a map of metalness"},
    MapKindInfo{MapKind::emission, "emission", "a map of emission"},
    MapKindInfo{MapKind::bent_normal, "bent normals", "a map of bent normals"},
    MapKindInfo{MapKind::thickness, "thickness", "a map of thickness"},
    MapKindInfo{MapKind::id, "ids", "a map of ids"},
};

static_assert([] {
    for (std::size_t i = 0; i < all_kinds.size(); ++i) {
        if (all_kinds[i].kind != static_cast<MapKind>(i)) return false;
    }
    return all_kinds.size() == enum_names<MapKind>.size();
}());

constexpr std::array<EnumName<ColorSpace>, 3> color_spaces = {
    {{"data", ColorSpace::data}, {"linear", ColorSpace::linear}, {"sRGB", ColorSpace::srgb}}};

/// Returns the value with a name in a table of names.
template <typename Table>
auto value_of(const Table& table, std::string_view name) {
    const auto found =
        std::find_if(table.begin(), table.end(), [&](const auto& e) { return name == e.name; });
    return found == table.end() ? std::nullopt : std::optional(found->value);
}

/// Reads the kind, and what follows it: "packed maps, unity".
void read_content(std::string_view text, MapDescription& description) {
    for (const MapKindInfo& info : all_kinds) {
        if (!text.starts_with(info.content)) continue;
        const std::string_view rest = text.substr(info.content.size());
        if (!rest.empty() && rest.front() != ',' && rest.front() != ' ') continue;
        description.kind = info.kind;
        description.detail = rest.starts_with(", ") ? rest.substr(2) : "";
    }
}

std::string content_of(const MapDescription& description, int) {
    if (!description.kind) return "";
    const std::string detail = description.detail.empty() ? "" : ", " + description.detail;
    return std::string(map_kind_info(*description.kind).content) + detail;
}

void read_flat(std::string_view text, MapDescription& description) {
    if (text == "127.5" || text == "32767.5") description.flat = FlatCode::half;
    if (text == "128" || text == "32768") description.flat = FlatCode::middle;
}

std::string flat_of(const MapDescription& description, int bits) {
    if (!description.flat) return "";
    if (bits == 32) return "0.5";
    const bool is_middle = *description.flat == FlatCode::middle;
    if (bits == 8) return is_middle ? "128" : "127.5";
    return is_middle ? "32768" : "32767.5";
}

/// A text entry. `write` returns an empty text if the description does not say it.
struct Entry {
    std::string_view key;
    void (*read)(std::string_view text, MapDescription& description);
    std::string (*write)(const MapDescription& description, int bits);
};

constexpr std::array all_entries = {
    Entry{"relief:content", read_content, content_of},
    Entry{"relief:green",
          [](std::string_view text, MapDescription& d) {
              d.green = value_of(enum_names<Green>, text);
          },
          [](const MapDescription& d, int) {
              return std::string(d.green ? enum_name(*d.green) : "");
          }},
    Entry{"relief:flat", read_flat, flat_of},
    Entry{"relief:channels",
          [](std::string_view text, MapDescription& d) { d.xy_only = text == "xy"; },
          [](const MapDescription& d, int) { return std::string(d.xy_only ? "xy" : ""); }},
    Entry{"relief:color-space",
          [](std::string_view text, MapDescription& d) {
              d.color_space = value_of(color_spaces, text);
          },
          [](const MapDescription& d, int) {
              if (!d.color_space) return std::string();
              const auto has_value = [&](const auto& e) { return e.value == *d.color_space; };
              return std::string(
                  std::find_if(color_spaces.begin(), color_spaces.end(), has_value)->name);
          }},
    Entry{"relief:alpha",
          [](std::string_view text, MapDescription& d) {
              d.alpha = value_of(enum_names<AlphaContent>, text);
          },
          [](const MapDescription& d, int) {
              return std::string(d.alpha ? enum_name(*d.alpha) : "");
          }},
};

constexpr auto all_keys = [] {
    std::array<std::string_view, all_entries.size()> keys;
    std::transform(all_entries.begin(), all_entries.end(), keys.begin(),
                   [](const Entry& entry) { return entry.key; });
    return keys;
}();

}  // namespace

const MapKindInfo& map_kind_info(MapKind kind) {
    return all_kinds[static_cast<std::size_t>(kind)];
}

MapDescription read_description(const std::map<std::string, std::string>& entries) {
    MapDescription description;
    for (const Entry& entry : all_entries) {
        const auto found = entries.find(std::string(entry.key));
        if (found != entries.end()) entry.read(found->second, description);
    }
    return description;
}

std::map<std::string, std::string> write_description(const MapDescription& description, int bits) {
    std::map<std::string, std::string> entries;
    for (const Entry& entry : all_entries) {
        std::string text = entry.write(description, bits);
        if (!text.empty()) entries.emplace(entry.key, std::move(text));
    }
    return entries;
}

std::span<const std::string_view> description_keys() {
    return all_keys;
}

}  // namespace relief
