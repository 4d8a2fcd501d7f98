// SPDX-License-Identifier: Apache-2.0
// Checks of images: whether they can be decoded, whether they are what their materials, metadata
// and names say, and the conditions of normal maps. Tests: tests/check/relief_check_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <span>
#include <utility>
#include <variant>

#include "check_files.h"
#include "common/command.h"
#include "common/text.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/map_kind_check.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/texture_file.h"
#include "texture_names.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

/// From this size on, a map without any detail is a warning: smaller ones are placeholders.
constexpr int min_wasteful_size = 64;

/// An image with what is known about it.
struct KnownImage {
    const ImageFacts& facts;
    MapDescription stated;
    NamedMap named;  ///< By the name of its file.
    const std::vector<ImageRole>& roles;
};

bool is_normal_slot(TextureSlot slot) {
    return slot == TextureSlot::normal || slot == TextureSlot::clearcoat_normal;
}

bool has_role(const KnownImage& known, bool (*is_asked)(const ImageRole&)) {
    return std::ranges::any_of(known.roles, is_asked);
}

bool is_gltf_normal(const ImageRole& role) {
    return role.is_gltf && is_normal_slot(role.slot);
}

/// Returns whether an image that no material uses should be normals in tangent space.
bool is_called_normals(const MapDescription& stated, const NamedMap& named) {
    return stated.kind ? *stated.kind == MapKind::normal : named.kind == MapKind::normal;
}

/// Returns the kinds of maps in a slot. None if it accepts any map.
std::vector<MapKind> kinds_in(const ImageRole& role) {
    switch (role.slot) {
        case TextureSlot::normal:
        case TextureSlot::clearcoat_normal:
            return {MapKind::normal};
        case TextureSlot::base_color:
            return {MapKind::color, MapKind::id};
        case TextureSlot::emission:
            return {MapKind::emission, MapKind::color};
        case TextureSlot::occlusion:
            return {MapKind::occlusion, MapKind::packed};
        case TextureSlot::metallic_roughness:
            return {MapKind::packed, MapKind::roughness, MapKind::metalness, MapKind::occlusion};
        case TextureSlot::bump:
        case TextureSlot::height:
            return {MapKind::height};
        default:
            return {};
    }
}

/// Returns the kinds that a map of this name may have.
std::vector<MapKind> kinds_named(MapKind named) {
    switch (named) {
        case MapKind::normal:
            return {MapKind::normal, MapKind::object_normal, MapKind::world_normal};
        case MapKind::occlusion:
        case MapKind::roughness:
        case MapKind::metalness:
        case MapKind::packed:
            return {MapKind::packed, MapKind::occlusion, MapKind::roughness, MapKind::metalness};
        case MapKind::color:
        case MapKind::emission:
            return {MapKind::color, MapKind::emission, MapKind::id};
        default:
            return {named};
    }
}

using enum MapContent;

constexpr const char* normals_problem = "is a normal map in tangent space, as its texels show";

/// Returns what is wrong with the kind of an image in a slot; empty if nothing is.
std::string wrong_kind(const KnownImage& known, const ImageRole& role) {
    const std::vector<MapKind> accepted = kinds_in(role);
    if (accepted.empty()) return "";
    if (const auto wrong = stated_wrong_kind(accepted, known.stated)) return wrong->problem;
    // check_normal_map() judges normals.
    if (is_normal_slot(role.slot)) return "";
    return known.facts.content == tangent_normals ? normals_problem : "";
}

std::string slot_text(const ImageRole& role) {
    const char* const slot = slot_info(role.slot).name;
    return role.material.empty() ? fmt::format("the {} map of the model", slot)
                                 : fmt::format("the {} of material '{}'", slot, role.material);
}

struct EmbeddedImage {
    std::string place;  ///< "image 2 'bricks'"
    std::size_t index = 0;
    bool can_be_replaced = false;
};

/// Adds the findings of one image to those of a file.
class ImageCheck {
  public:
    ImageCheck(const KnownImage& known, CheckedItem& item)
        : known_(known), is_fixable_(can_be_fixed(item.file)), item_(item) {}

    /// Checks an embedded image.
    ImageCheck(const KnownImage& known, const EmbeddedImage& image, CheckedItem& item)
        : known_(known),
          place_(image.place),
          index_(image.index),
          is_fixable_(image.can_be_replaced && can_be_fixed(item.file)),
          item_(item) {}

    void run() {
        check_roles();
        check_size();
        if (known_.facts.are_normals) check_normals();
        if (known_.roles.empty()) check_name();
    }

  private:
    void add(const CheckRule& rule, CheckSeverity severity, const std::string& text,
             std::size_t count = 1) {
        item_.findings.push_back(
            {&rule, severity, place_, text, count, rule.is_fixable() && is_fixable_, index_});
    }
    void add(const char* id, const std::string& text) {
        const CheckRule& rule = rule_named(id);
        add(rule, rule.severity, text);
    }

    void check_roles() {
        std::string wrong_text, color, number;
        for (const ImageRole& role : known_.roles) {
            const std::string problem = wrong_kind(known_, role);
            if (!problem.empty() && wrong_text.empty())
                wrong_text = fmt::format("{} {}", slot_text(role), problem);
            const TextureSlotInfo& slot = slot_info(role.slot);
            // A color and a number in alpha share an image by design.
            if (slot.use == ImageUse::color) color = slot_text(role);
            if (slot.use == ImageUse::data && std::string_view(slot.channels) != "a")
                number = slot_text(role);
        }
        if (!wrong_text.empty()) add("texture/wrong-kind", wrong_text);
        if (!color.empty() && !number.empty())
            add("texture/two-uses", fmt::format("is {} and {}", color, number));
        check_material();
    }

    void check_material() {
        const auto stated = known_.facts.metadata.find("relief:material");
        if (stated == known_.facts.metadata.end() || known_.roles.empty()) return;
        const bool is_used = std::ranges::any_of(
            known_.roles, [&](const ImageRole& role) { return role.material == stated->second; });
        const auto other = std::ranges::find_if(known_.roles, [&](const ImageRole& role) {
            return std::ranges::find(role.materials, stated->second) != role.materials.end();
        });
        if (is_used || other == known_.roles.end()) return;
        add("texture/other-material", fmt::format("is {}, but was baked for material '{}'",
                                                  slot_text(*other), stated->second));
    }

    void check_size() {
        const auto is_power = [](int side) { return (side & (side - 1)) == 0; };
        const glm::ivec2 size = known_.facts.texels;
        if (known_.roles.empty() || (is_power(size.x) && is_power(size.y))) return;
        add("texture/not-power-of-two", fmt::format("has {} x {} texels", size.x, size.y));
    }

    /// Maps that no model uses must be what their name says.
    void check_name() {
        if (!known_.named.kind) return;
        if (const auto wrong = stated_wrong_kind(kinds_named(*known_.named.kind), known_.stated))
            return add("map/contradicts-name", wrong->problem);
        // "rock_nrm_rgh" has roughness in a fourth channel.
        const bool are_normals = *known_.named.kind == MapKind::normal ||
                                 named_map(known_.named.set).kind == MapKind::normal;
        if (!are_normals && known_.facts.content == tangent_normals)
            add("map/contradicts-name", normals_problem);
    }

    void check_normals() {
        for (const MapConditionCount& found : known_.facts.conditions)
            add_condition(found);
    }

    void add_condition(const MapConditionCount& found) {
        const MapConditionInfo& info = condition_info(found.condition);
        std::string text =
            info.element == "map"
                ? fmt::format("{}: {}", info.word, info.meaning)
                : to_string(PlacedFinding{"",
                                          {std::string(info.word), std::string(info.element),
                                           std::string(info.meaning), found.count, found.first},
                                          known_.facts.texels.x});
        if (found.condition == MapCondition::green_down && has_role(known_, is_gltf_normal)) {
            const CheckRule& rule = rule_named("texture/green-down");
            return add(rule, rule.severity, text, found.count);
        }
        const CheckRule& rule = check_rule_of(found.condition);
        add(rule, severity_of(rule, found.condition), text, found.count);
    }

    [[nodiscard]] CheckSeverity severity_of(const CheckRule& rule, MapCondition condition) const {
        const int size = std::min(known_.facts.texels.x, known_.facts.texels.y);
        switch (condition) {
            case MapCondition::texel_facing_back:
                // The high surface of a bake may lean so far. Maps of relief say what they are.
                return known_.stated.kind ? CheckSeverity::note : rule.severity;
            case MapCondition::all_flat:
                return size < min_wasteful_size ? CheckSeverity::note : rule.severity;
            case MapCondition::z_missing:
                return has_role(known_, is_gltf_normal) ? CheckSeverity::error : rule.severity;
            default:
                return rule.severity;
        }
    }

    KnownImage known_;
    std::string place_;
    std::optional<std::size_t> index_;
    bool is_fixable_;
    CheckedItem& item_;
};

ImageFigures figures_of(const ImageInfo& info, std::uint64_t texture_bytes) {
    // Mip levels add a third.
    const std::uint64_t texels =
        static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height);
    return {info.width, info.height, texture_bytes > 0 ? texture_bytes : texels * 4 * 4 / 3};
}

/// Returns the bytes of the levels of a texture for GPUs; 0 for other images.
std::uint64_t texture_bytes(const fs::path& file) {
    const std::string extension = extension_of(file);
    if (extension != ".ktx2" && extension != ".dds") return 0;
    std::uint64_t bytes = 0;
    for (const std::vector<std::byte>& level : read_texture(file).levels)
        bytes += level.size();
    return bytes;
}

/// Adds what the texels show.
void measure_texels(const Image& image, const std::string& color_tag, const NamedMap& named,
                    bool judges_content, ImageFacts& facts) {
    const MapDescription stated = read_description(facts.metadata);
    if (judges_content) facts.content = unstated_content(image, stated);
    if (!facts.are_normals) return;
    std::map<std::string, std::string> metadata = facts.metadata;
    if (named.green && !stated.green) metadata["relief:green"] = enum_name(*named.green);
    facts.conditions = check_normal_map(image, metadata, color_tag).conditions;
}

/// Returns whether a check of an image with these uses needs its content.
bool needs_content(const std::vector<ImageRole>& roles, const NamedMap& named) {
    if (roles.empty()) return named.kind.has_value();
    return std::ranges::any_of(roles, [](const ImageRole& role) {
        return !is_normal_slot(role.slot) && !kinds_in(role).empty();
    });
}

void measure(const fs::path& file, bool judges_content, std::optional<bool> as_normals,
             ImageFacts& facts) {
    std::error_code error;
    // A pipe would block.
    if (fs::exists(file, error) && !fs::is_regular_file(file, error))
        throw FileError(file, "is not a regular file");
    const ImageInfo info = read_image_info(file);
    const NamedMap named = named_map(file.stem().string());
    facts.metadata = info.metadata;
    facts.are_normals =
        as_normals.value_or(is_called_normals(read_description(info.metadata), named));
    const Image image =
        facts.are_normals ? read_normal_map_image(file) : read_image(file, ImageUse::data);
    facts.figures = figures_of(info, texture_bytes(file));
    facts.texels = {image.width, image.height};
    measure_texels(image, color_tag(file), named, judges_content, facts);
}

}  // namespace

std::string_view image_suffix(std::span<const std::byte> bytes) {
    const auto begins = [&](std::initializer_list<int> start) {
        return bytes.size() >= start.size() &&
               std::ranges::equal(start, bytes.first(start.size()), {}, {},
                                  [](std::byte byte) { return std::to_integer<int>(byte); });
    };
    if (begins({0x89, 'P', 'N', 'G'})) return ".png";
    return begins({0xFF, 0xD8}) ? ".jpg" : "";
}

std::optional<bool> are_used_as_normals(const std::vector<ImageRole>& roles) {
    if (roles.empty()) return std::nullopt;
    return std::ranges::any_of(roles,
                               [](const ImageRole& role) { return is_normal_slot(role.slot); });
}

ImageFacts measure_image_file(const fs::path& file, std::optional<bool> as_normals,
                              bool judges_content) {
    ImageFacts facts;
    facts.file = file;
    facts.is_unused = !as_normals;
    facts.are_normals = as_normals.value_or(false);
    try {
        measure(file, judges_content, as_normals, facts);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::bad_alloc&) {
        facts.fault = "out of memory";
    } catch (const std::exception& error) {
        facts.fault = reason_of(error.what(), file);
    }
    return facts;
}

CheckedItem judge_image(const ImageFacts& facts, const std::vector<ImageRole>& roles) {
    CheckedItem item;
    item.file = facts.file;
    item.kind = CheckedKind::image;
    if (!facts.fault.empty()) {
        item.is_unreadable = true;
        item.add(rule_named("file/unreadable"), "", facts.fault);
        return item;
    }
    item.image = facts.figures;
    const KnownImage known{facts, read_description(facts.metadata),
                           named_map(facts.file.stem().string()), roles};
    ImageCheck(known, item).run();
    return item;
}

CheckedItem check_image_file(const fs::path& file, const std::vector<ImageRole>& roles) {
    const FileStamp stamp = stamp_of(file);
    const bool judges_content = needs_content(roles, named_map(file.stem().string()));
    CheckedItem item =
        judge_image(measure_image_file(file, are_used_as_normals(roles), judges_content), roles);
    item.inputs.emplace(file, stamp);
    return item;
}

ImageFigures check_embedded_image(const GltfImage& image, std::size_t index,
                                  const std::vector<ImageRole>& roles, CheckedItem& item) {
    const std::string name = image.name.empty() ? "" : fmt::format(" '{}'", image.name);
    const std::string place = fmt::format("image {}{}", index, name);
    const auto& bytes = std::get<std::vector<std::byte>>(image.source);
    try {
        if (!image.fault.empty()) throw InvalidInput(image.fault);
        const ImageInfo info = read_image_info(bytes, place);
        const Image texels = read_image(bytes, place, ImageUse::data);
        const NamedMap named = named_map(image.name);
        ImageFacts facts;
        facts.metadata = info.metadata;
        facts.figures = figures_of(info, 0);
        facts.texels = {texels.width, texels.height};
        const MapDescription stated = read_description(info.metadata);
        facts.are_normals = are_used_as_normals(roles).value_or(is_called_normals(stated, named));
        measure_texels(texels, "", named, needs_content(roles, named), facts);
        const EmbeddedImage embedded{place, index, !roles.empty() && !image_suffix(bytes).empty()};
        ImageCheck({facts, stated, named, roles}, embedded, item).run();
        return facts.figures;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        item.add(rule_named("texture/unreadable"), place, reason_of(error.what(), place));
        return {};
    }
}

}  // namespace relief::tools
