// SPDX-License-Identifier: Apache-2.0
#include "map_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <variant>

#include "arrays.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/texture_file.h"
#include "relief/shade/frame_settings.h"

namespace relief::python {
namespace {

/// Returns what to do with a map that seems to be of another kind.
std::string remedy_for(const std::optional<MapKind>& seeming, MapKind wanted) {
    if (wanted == MapKind::normal && seeming == MapKind::height)
        return "bump() converts height maps";
    if (wanted == MapKind::height && seeming == MapKind::normal)
        return "decode_normals() and heights() convert normal maps";
    if (wanted == MapKind::normal && seeming == MapKind::object_normal)
        return "decode_normals() and convert_space() convert it";
    return fmt::format("give {}", map_kind_info(wanted).phrase);
}

/// Returns the problem of a map, and its remedy. \param assume  the value of the argument, with {}
std::string problem_of(const WrongMapKind& wrong, MapKind wanted, const char* assume) {
    return fmt::format("{} ({}; assume={} reads it anyway)", wrong.problem,
                       remedy_for(wrong.kind, wanted),
                       fmt::format(fmt::runtime(assume), enum_name(wanted)));
}

/// Returns the problem of a file; nothing also if it cannot be read.
std::optional<WrongMapKind> wrong_kind_of(const std::filesystem::path& file,
                                          const std::vector<MapKind>& accepted) {
    try {
        const MapDescription stated = read_description(read_image_info(file).metadata);
        if (auto wrong = stated_wrong_kind(accepted, stated)) return wrong;
        if (stated.kind || !is_judged_by_texels(accepted)) return std::nullopt;
        const auto content = unstated_content(read_normal_map_image(file), stated);
        return content ? judged_wrong_kind(accepted, *content) : std::nullopt;
    } catch (const FileError&) {
        return std::nullopt;
    }
}

}  // namespace

void check_kind(const ImageView& map, const char* name, const std::vector<MapKind>& accepted,
                const std::optional<std::string>& assume) {
    const MapKind wanted = accepted.front();
    const std::string kind(enum_name(wanted));
    if (assume && *assume != kind) refuse_name("assume", *assume, {kind});
    if (assume) return;
    const std::optional<MapContent> content = unstated_content(map, MapDescription{});
    if (!content) return;
    const std::optional<WrongMapKind> wrong = judged_wrong_kind(accepted, *content);
    if (wrong)
        throw InvalidInput(fmt::format("{}: {}", name, problem_of(*wrong, wanted, "\"{}\"")));
}

std::vector<MapKind> assumed_kinds(const std::vector<std::string>& names) {
    constexpr auto known = std::to_array<EnumName<MapKind>>(
        {{"normal", MapKind::normal}, {"height", MapKind::height}, {"color", MapKind::color}});
    std::vector<MapKind> kinds;
    for (const std::string& name : names)
        kinds.push_back(value_of<MapKind>(name, "assume", known));
    return kinds;
}

void check_scene_maps(const shade::Scene& scene, const std::filesystem::path& file,
                      const std::vector<MapKind>& assumed) {
    std::set<std::pair<std::size_t, TextureSlot>> checked;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        for (const TextureSlotInfo& info : texture_slots) {
            const Texture* const texture = find_texture(scene.materials[i], info.slot);
            const std::vector<MapKind> accepted = accepted_kinds(info.slot);
            if (texture == nullptr || accepted.empty()) continue;
            const shade::ImageSource& image = scene.images[texture->image];
            const auto* const map = std::get_if<std::filesystem::path>(&image.source);
            const bool is_named = map != nullptr && image.origin == file.string();
            if (!is_named || !checked.emplace(texture->image, info.slot).second) continue;
            if (std::ranges::count(assumed, accepted.front()) > 0) continue;
            if (const auto wrong = wrong_kind_of(*map, accepted)) {
                throw FileError(
                    file,
                    fmt::format("{} of {}: {}: {}", info.effect, shade::material_label(scene, i),
                                map->string(), problem_of(*wrong, accepted.front(), "[\"{}\"]")));
            }
        }
    }
}

Report without_assumed(const Report& report, const std::vector<MapKind>& assumed) {
    Report rest;
    for (const Finding& finding : report.findings()) {
        const bool is_assumed = std::ranges::any_of(assumed, [&](MapKind kind) {
            // The space of normals has an argument of its own.
            return finding.outcome == drawn_as(kind) ||
                   (kind == MapKind::normal && finding.outcome == drawn_as(MapKind::object_normal));
        });
        if (!is_assumed) rest.add(finding);
    }
    return rest;
}

}  // namespace relief::python
