// SPDX-License-Identifier: Apache-2.0
// Continues an asset with edited maps. Tests: tests/make/make_baked_test.cpp.
#include "make_baked.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/command.h"
#include "common/content_hash.h"
#include "common/summary.h"
#include "make_parts.h"
#include "make_stages.h"
#include "mesh_maps.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

constexpr const char* bake_again = "run without --from, or continue at bake";

/// The factors that a bake decides. All others are those of the source.
Json factors_json(const GltfMaterial& material) {
    const MetallicRoughness& surface = *material.metallic_roughness;
    const auto color = [](const glm::vec3& c) -> Json { return {c.r, c.g, c.b}; };
    return {{"base_color", color(surface.base_color)},
            {"opacity", material.opacity},
            {"roughness", surface.roughness},
            {"metallic", surface.metallic},
            {"emission", color(material.emission_factor)},
            {"emission_strength", material.emission_strength}};
}

void set_factors(GltfMaterial& material, const Json& json) {
    const auto color = [](const Json& c) {
        return glm::vec3(c.at(0).get<float>(), c.at(1).get<float>(), c.at(2).get<float>());
    };
    MetallicRoughness& surface = *material.metallic_roughness;
    surface.base_color = color(json.at("base_color"));
    material.opacity = json.at("opacity").get<float>();
    surface.roughness = json.at("roughness").get<float>();
    surface.metallic = json.at("metallic").get<float>();
    material.emission_factor = color(json.at("emission"));
    material.emission_strength = json.at("emission_strength").get<float>();
}

std::vector<make::DrawMode> draw_modes_of_record(const Json& json) {
    std::vector<make::DrawMode> modes;
    for (const Json& mode : json) {
        const auto alpha = std::ranges::find(
            enum_names<AlphaMode>, mode.at("alpha_mode").get<std::string>(),
            [](const EnumName<AlphaMode>& entry) { return std::string(entry.name); });
        if (alpha == enum_names<AlphaMode>.end()) throw InvalidInput("has a damaged alpha mode");
        modes.push_back({alpha->value, mode.at("alpha_cutoff").get<float>(),
                         mode.at("double_sided").get<bool>()});
    }
    if (modes.empty()) throw InvalidInput("has no alpha mode");
    return modes;
}

/// Gives an asset the materials that a bake decided. A mesh that was edited so that its alpha is
/// not known gets the most transparent one.
void set_draw_modes(make::Asset& asset, const std::vector<make::DrawMode>& modes,
                    const std::vector<AlphaMode>& alpha_modes, Report& report) {
    GltfMaterial& material = asset.material;
    const auto take = [&](const make::DrawMode& mode) {
        material.alpha_mode = mode.alpha_mode;
        material.alpha_cutoff = mode.alpha_cutoff;
        material.double_sided = mode.double_sided;
    };
    take(modes.front());
    if (modes.size() < 2) return;
    const auto number_of = [&](AlphaMode alpha) {
        return static_cast<std::uint32_t>(
            std::ranges::find(modes, alpha, &make::DrawMode::alpha_mode) - modes.begin());
    };
    const bool is_known =
        !alpha_modes.empty() && std::ranges::all_of(alpha_modes, [&](AlphaMode alpha) {
            return number_of(alpha) < modes.size();
        });
    if (!is_known) {
        report.add("mesh of several materials that was edited", "asset", 0,
                   "has one, because alpha modes of its triangles are not known");
        take(modes.back());
        return;
    }
    asset.draw_modes = modes;
    for (std::uint32_t i = 0; i < alpha_modes.size(); ++i) {
        const std::uint32_t number = number_of(alpha_modes[i]);
        std::vector<MaterialRange>& ranges = asset.mesh.material_ranges;
        if (ranges.empty() || ranges.back().material != number) ranges.push_back({i, 0, number});
        ++ranges.back().triangle_count;
    }
}

/// The form of a map in the asset.
struct MapForm {
    int width = 0, height = 0, channels = 0, bits = 0;
    ColorSpace color_space = ColorSpace::data;
};

/// Returns a sample in the codes of other bits.
template <typename To, typename From>
To recoded(From code) {
    if constexpr (sizeof(To) == sizeof(From))
        return code;
    else if constexpr (sizeof(To) > sizeof(From))
        return static_cast<To>(257 * code);
    else
        return static_cast<To>((std::uint32_t{code} * 255 + 32767) / 65535);
}

/// Returns an image with other channels and bits. Gray becomes RGB, and RGB its first channel.
template <typename To, typename From>
Image converted(const Image& image, int channels) {
    const std::span<const From> from = image.as<From>();
    const auto count = static_cast<std::size_t>(image.channels);
    const std::size_t colors = image.channels <= 2 ? 1 : 3;
    const bool has_alpha = image.channels == 2 || image.channels == 4;
    std::vector<To> to;
    to.reserve(from.size() / count * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < from.size(); i += count) {
        for (int channel = 0; channel < std::min(channels, 3); ++channel)
            to.push_back(
                recoded<To>(from[i + std::min(static_cast<std::size_t>(channel), colors - 1)]));
        if (channels < 4) continue;
        to.push_back(has_alpha ? recoded<To>(from[i + count - 1]) : static_cast<To>(~To{0}));
    }
    Image result = image;
    result.channels = channels;
    result.samples = std::move(to);
    return result;
}

template <typename From>
Image converted(const Image& image, const MapForm& form) {
    return form.bits == 8 ? converted<std::uint8_t, From>(image, form.channels)
                          : converted<std::uint16_t, From>(image, form.channels);
}

/// Returns whether a texel of an image is not opaque.
template <typename Code>
bool is_transparent(const Image& image) {
    const std::span<const Code> samples = image.as<Code>();
    const auto count = static_cast<std::size_t>(image.channels);
    for (std::size_t i = count - 1; i < samples.size(); i += count) {
        if (samples[i] != static_cast<Code>(~Code{0})) return true;
    }
    return false;
}

/// Reads a map in its form. \throws FileError if it cannot be converted
Image read_map(const std::filesystem::path& file, const MapForm& form) {
    const ImageUse use = form.color_space == ColorSpace::srgb ? ImageUse::color : ImageUse::data;
    Image image = read_image(file, use);
    if (image.width != form.width || image.height != form.height) {
        throw failure(file,
                      fmt::format("has {} x {} texels, but was baked with {} x {}", image.width,
                                  image.height, form.width, form.height),
                      "keep its size, or bake maps of another --size");
    }
    if (image.bits() > 16)
        throw failure(file, "has floating-point samples", "save it with 8 or 16 bits");
    const bool has_alpha = image.channels == 2 || image.channels == 4;
    const bool loses_alpha = has_alpha && form.channels != 4 &&
                             (image.bits() == 8 ? is_transparent<std::uint8_t>(image)
                                                : is_transparent<std::uint16_t>(image));
    if (loses_alpha)
        throw failure(file, "has transparent texels, but the map was baked without opacity",
                      "save it without alpha");
    if (image.channels != form.channels || image.bits() != form.bits) {
        image = image.bits() == 8 ? converted<std::uint8_t>(image, form)
                                  : converted<std::uint16_t>(image, form);
    }
    image.color_space = form.color_space;
    return image;
}

/// The inverse of ids_json(). \throws InvalidInput if a color is damaged
std::vector<SurfaceId> ids_of(const Json& json) {
    std::vector<SurfaceId> ids;
    for (const Json& id : json) {
        const auto text = id.at("color").get<std::string>();
        unsigned color = 0;
        const char* const end = text.data() + text.size();
        const bool is_hash = text.size() == 7 && text[0] == '#';
        if (!is_hash || std::from_chars(text.data() + 1, end, color, 16).ptr != end)
            throw InvalidInput("has a damaged color");
        ids.push_back({id.at("name").get<std::string>(),
                       glm::u8vec3(color >> 16, color >> 8 & 0xFFU, color & 0xFFU)});
    }
    return ids;
}

/// Reads the maps of a record into an asset.
class MapReader {
  public:
    MapReader(const std::filesystem::path& folder, const Json& maps, Report& report)
        : folder_(folder), maps_(maps), report_(report) {}

    std::optional<Image> read(const std::string& name) {
        const std::filesystem::path file = folder_ / map_file_name(name);
        const auto found = maps_.find(name);
        if (found == maps_.end()) {
            if (std::filesystem::exists(file))
                report_.add("map file that was not baked", "file", 0,
                            fmt::format("{} is not used", file.string()));
            return std::nullopt;
        }
        if (!std::filesystem::exists(file))
            throw failure(file, "is missing, but --from write needs it", bake_again);
        if (found->at("hash") != file_hash(file))
            report_.add("stage file that was edited", "file", 0,
                        fmt::format("{} replaces the result of its stage", file.string()));
        const MapForm form = {
            found->at("width").get<int>(), found->at("height").get<int>(),
            found->at("channels").get<int>(), found->at("bits").get<int>(),
            found->at("is_srgb").get<bool>() ? ColorSpace::srgb : ColorSpace::data};
        return read_map(file, form);
    }

  private:
    const std::filesystem::path& folder_;
    const Json& maps_;
    Report& report_;
};

}  // namespace

Json baked_record(const std::filesystem::path& folder, const make::Asset& asset) {
    Json maps = Json::object();
    for (const make::AssetMap& map : make::maps_of(asset)) {
        maps[map.name] = {{"hash", file_hash(folder / map_file_name(map.name))},
                          {"width", map.image->width},
                          {"height", map.image->height},
                          {"channels", map.image->channels},
                          {"bits", map.image->bits()},
                          {"is_srgb", map.image->color_space == ColorSpace::srgb}};
    }
    const BakeResult& bake = asset.bake;
    return {{"maps", std::move(maps)},
            {"layers", json_list(asset.layers,
                                 [](const make::AssetLayer& layer) -> Json {
                                     return {{"name", make::layer_name(layer.coding.kind)},
                                             {"range", layer.coding.range},
                                             {"ids", ids_json(layer.coding.ids)}};
                                 })},
            {"material", factors_json(asset.material)},
            {"draw_modes", json_list(draw_modes_of(asset),
                                     [](const make::DrawMode& mode) -> Json {
                                         return {{"alpha_mode", enum_name(mode.alpha_mode)},
                                                 {"alpha_cutoff", mode.alpha_cutoff},
                                                 {"double_sided", mode.double_sided}};
                                     })},
            {"surface_has_occlusion", asset.surface_has_occlusion},
            {"source_triangles", asset.source_triangles},
            {"parts", parts_json(asset.parts)},
            {"texels_baked", bake.texels_baked},
            {"texels_missed", bake.texels_missed},
            {"rays", bake.rays},
            {"occlusion_rays", bake.occlusion_rays},
            {"thickness_rays", bake.thickness_rays},
            {"open_thickness_rays", bake.open_thickness_rays},
            {"min_height", bake.min_height},
            {"max_height", bake.max_height}};
}

make::Asset read_baked(const MakeRequest& request, const make::AssetSource& source,
                       make::AssetStart start, const Json& record, Report& report) {
    const std::filesystem::path& folder = *request.stages_folder;
    make::Asset asset;
    asset.name = source.name;
    asset.mesh = std::move(start.mesh);
    asset.mesh.name = source.name;
    asset.origin = source.origin;
    asset.material = source.shared;
    try {
        const Json& bake = record.at("bake");
        MapReader maps(folder, bake.at("maps"), report);
        std::optional<Image> normals = maps.read("normal");
        if (!normals) throw InvalidInput("has no normal map");
        asset.normal_map = std::move(*normals);
        asset.occlusion_map = maps.read("occlusion");
        asset.color_map = maps.read("color");
        asset.surface_map = maps.read("orm");
        asset.emission_map = maps.read("emission");
        const Json& layers = bake.at("layers");
        for (std::size_t i = 0; i < request.asset.layers.size(); ++i) {
            const LayerKind kind = request.asset.layers[i];
            std::optional<Image> image = maps.read(make::layer_name(kind));
            if (!image) throw InvalidInput("has no layer " + make::layer_name(kind));
            LayerCoding coding{kind, image->bits(), layers.at(i).at("range").get<double>()};
            coding.ids = ids_of(layers.at(i).at("ids"));
            asset.layers.push_back({std::move(coding), std::move(*image)});
        }
        set_factors(asset.material, bake.at("material"));
        set_draw_modes(asset, draw_modes_of_record(bake.at("draw_modes")), start.alpha_modes,
                       report);
        asset.surface_has_occlusion = bake.at("surface_has_occlusion").get<bool>();
        asset.source_triangles = bake.at("source_triangles").get<std::size_t>();
        asset.parts.is_matched = bake.at("parts").at("matched").get<bool>();
        const Json& reason = bake.at("parts").at("reason");
        if (reason.is_string()) asset.parts.reason = reason.get<std::string>();
        for (const Json& part : bake.at("parts").at("parts"))
            asset.parts.parts.push_back({part.at("name").get<std::string>(),
                                         part.at("source_triangles").get<std::size_t>(),
                                         part.at("triangles").get<std::size_t>()});
        asset.bake.texels_baked = bake.at("texels_baked").get<std::size_t>();
        asset.bake.texels_missed = bake.at("texels_missed").get<std::size_t>();
        asset.bake.rays = bake.at("rays").get<std::size_t>();
        asset.bake.occlusion_rays = bake.at("occlusion_rays").get<std::size_t>();
        asset.bake.thickness_rays = bake.at("thickness_rays").get<std::size_t>();
        asset.bake.open_thickness_rays = bake.at("open_thickness_rays").get<std::size_t>();
        asset.bake.min_height = bake.at("min_height").get<double>();
        asset.bake.max_height = bake.at("max_height").get<double>();
    } catch (const Json::exception&) {
        throw failure(folder / "stages.json", "has no bake, or is damaged", bake_again);
    } catch (const InvalidInput& error) {
        throw failure(folder / "stages.json", error.what(), bake_again);
    }
    return asset;
}

}  // namespace relief::tools
