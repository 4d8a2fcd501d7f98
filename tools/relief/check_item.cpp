// SPDX-License-Identifier: Apache-2.0
// Stores checked files in the cache and reads them again. Tests: tests/check/relief_check_test.cpp.
#include "check_item.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/exact_json.h"

namespace relief::tools {

const CheckRule& rule_named(std::string_view id) {
    const CheckRule* const rule = find_check_rule(id);
    assert(rule != nullptr);
    return *rule;
}

void CheckedItem::add(const CheckRule& rule, const std::string& place, const std::string& text,
                      std::size_t count) {
    findings.push_back(
        {&rule, rule.severity, place, text, count, rule.is_fixable() && can_be_fixed(file)});
}

bool can_be_fixed(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 8> formats = {".glb", ".gltf", ".obj",  ".ply",
                                                                ".png", ".tif",  ".tiff", ".exr"};
    return std::ranges::find(formats, extension_of(file)) != formats.end();
}

Json json_of(const ImageFigures& image) {
    return {{"width", image.width}, {"height", image.height}, {"bytes", image.bytes}};
}

ImageFigures image_figures_of(const Json& json) {
    return {json.at("width"), json.at("height"), json.at("bytes")};
}

namespace {

Json json_of(const MaterialFigures& surface) {
    return {{"name", text_json(surface.name)},
            {"surface_area", number_json(surface.surface_area)},
            {"texture_area", number_json(surface.texture_area)},
            {"file", surface.file ? text_json(surface.file->string()) : Json()},
            {"embedded", or_null(surface.embedded)}};
}

MaterialFigures surface_of(const Json& json) {
    MaterialFigures surface{text_in(json.at("name")),
                            number_in(json.at("surface_area")),
                            number_in(json.at("texture_area")),
                            {},
                            {}};
    if (!json.at("file").is_null()) surface.file = text_in(json.at("file"));
    if (!json.at("embedded").is_null()) surface.embedded = json.at("embedded").get<std::size_t>();
    return surface;
}

Json json_of(const CheckFinding& finding) {
    return {{"rule", finding.rule->id},
            {"severity", enum_name(finding.severity)},
            {"place", text_json(finding.place)},
            {"text", text_json(finding.text)},
            {"count", finding.count},
            {"is_fixable", finding.is_fixable},
            {"image", or_null(finding.image)}};
}

CheckSeverity severity_named(const std::string& name) {
    for (const auto& entry : enum_names<CheckSeverity>) {
        if (entry.name == name) return entry.value;
    }
    throw std::out_of_range(name);
}

CheckFinding finding_of(const Json& json) {
    const CheckRule* const rule = find_check_rule(json.at("rule").get<std::string>());
    if (rule == nullptr) throw std::out_of_range("rule");
    const Json& image = json.at("image");
    return {rule,
            severity_named(json.at("severity")),
            text_in(json.at("place")),
            text_in(json.at("text")),
            json.at("count"),
            json.at("is_fixable"),
            image.is_null() ? std::nullopt : std::optional<std::size_t>(image)};
}

Json json_of(const UsedImage& image) {
    return {{"file", text_json(image.file.string())},
            {"slot", static_cast<int>(image.role.slot)},
            {"is_gltf", image.role.is_gltf},
            {"material", text_json(image.role.material)},
            {"materials", texts_json(image.role.materials)}};
}

template <typename Thing>
std::vector<Thing> list_of(const Json& json, Thing (*thing_of)(const Json&)) {
    std::vector<Thing> list;
    for (const Json& one : json)
        list.push_back(thing_of(one));
    return list;
}

UsedImage used_image_of(const Json& json) {
    const int slot = json.at("slot");
    if (slot < 0 || slot >= static_cast<int>(texture_slot_count)) throw std::out_of_range("slot");
    return {text_in(json.at("file")),
            {static_cast<TextureSlot>(slot), json.at("is_gltf"), text_in(json.at("material")),
             list_of<std::string>(json.at("materials"), text_in)}};
}

}  // namespace

Json json_of(const CheckedItem& item) {
    const auto all = [](const auto& things) {
        return json_list(things, [](const auto& thing) { return json_of(thing); });
    };
    return {{"file", text_json(item.file.string())},
            {"kind", static_cast<int>(item.kind)},
            {"is_unreadable", item.is_unreadable},
            {"findings", all(item.findings)},
            {"triangles", item.model.triangles},
            {"vertices", item.model.vertices},
            {"materials", item.model.materials},
            {"surfaces", all(item.model.surfaces)},
            {"embedded", all(item.model.embedded)},
            {"image", json_of(item.image)},
            {"images", all(item.images)}};
}

CheckedKind checked_kind_of(const Json& json) {
    const int kind = json.get<int>();
    if (kind < 0 || kind > static_cast<int>(CheckedKind::folder)) throw std::out_of_range("kind");
    return static_cast<CheckedKind>(kind);
}

CheckedItem item_of(const Json& json) {
    CheckedItem item;
    item.file = text_in(json.at("file"));
    item.kind = checked_kind_of(json.at("kind"));
    item.is_unreadable = json.at("is_unreadable");
    item.findings = list_of<CheckFinding>(json.at("findings"), finding_of);
    item.model.triangles = json.at("triangles");
    item.model.vertices = json.at("vertices");
    item.model.materials = json.at("materials");
    item.model.surfaces = list_of<MaterialFigures>(json.at("surfaces"), surface_of);
    item.model.embedded = list_of<ImageFigures>(json.at("embedded"), image_figures_of);
    item.image = image_figures_of(json.at("image"));
    item.images = list_of<UsedImage>(json.at("images"), used_image_of);
    return item;
}

}  // namespace relief::tools
