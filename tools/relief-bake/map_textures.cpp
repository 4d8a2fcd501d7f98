// SPDX-License-Identifier: Apache-2.0
#include "map_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <variant>

#include "common/options.h"
#include "common/text.h"
#include "pack.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

/// Copies channels of an image. \param from  the channel of each result channel
Image selected_channels(const Image& image, const std::vector<int>& from) {
    Image result = make_image(image.width, image.height, static_cast<int>(from.size()),
                              image.bits(), image.color_space);
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            const auto all = image.as<Sample>();
            const auto held = static_cast<std::size_t>(image.channels);
            for (std::size_t i = 0; i < samples.size(); ++i) {
                samples[i] =
                    all[i / from.size() * held + static_cast<std::size_t>(from[i % from.size()])];
            }
        },
        result.samples);
    return result;
}

/// Returns whether the last channel is the maximum everywhere.
bool is_opaque(const Image& image) {
    return std::visit(
        [&]<typename Sample>(const std::vector<Sample>& samples) {
            const auto channels = static_cast<std::size_t>(image.channels);
            constexpr Sample full =
                std::is_same_v<Sample, float> ? Sample(1) : std::numeric_limits<Sample>::max();
            for (std::size_t i = channels - 1; i < samples.size(); i += channels) {
                if (samples[i] < full) return false;
            }
            return true;
        },
        image.samples);
}

}  // namespace

Choices<TextureFormat> texture_format_choices() {
    Choices<TextureFormat> choices;
    for (const EnumName<TextureFormat>& entry : enum_names<TextureFormat>) {
        const bool is_used = std::ranges::any_of(map_texture_kinds(), [&](const auto& kind) {
            return std::ranges::count(kind.formats, entry.value) > 0;
        });
        if (is_used) choices.emplace_back(entry.name, entry.value);
    }
    return choices;
}

Choices<MapKind> texture_kind_choices() {
    Choices<MapKind> choices;
    for (const MapTextureKind& kind : map_texture_kinds())
        choices.emplace_back(enum_name(kind.kind), kind.kind);
    return choices;
}

bool are_normals(MapKind kind) {
    return kind == MapKind::normal || kind == MapKind::object_normal;
}

Image read_value_map(const std::filesystem::path& file, MapKind kind, std::optional<int> channel,
                     bool keeps_alpha) {
    const MapTextureKind& row = *find_map_texture_kind(kind);
    Image image = read_image(file, row.is_color ? ImageUse::color : ImageUse::data);
    if (row.channels == 1)
        return selected_channels(image, {channel_to_read({file, channel}, image)});
    const bool has_alpha = image.channels % 2 == 0;
    const bool is_gray = image.channels < 3;
    std::vector<int> from = is_gray ? std::vector<int>{0, 0, 0} : std::vector<int>{0, 1, 2};
    if (has_alpha && keeps_alpha && !is_opaque(image)) from.push_back(image.channels - 1);
    if (static_cast<std::size_t>(image.channels) == from.size()) return image;
    return selected_channels(image, from);
}

WrittenTexture write_map_texture(const std::filesystem::path& file, MapKind kind,
                                 MapTexture encoded, std::optional<int> zstd_level,
                                 Report& report) {
    write_texture(file, encoded.texture, {zstd_level}, report);
    encoded.texture.levels.clear();
    return {file, kind, std::move(encoded.texture), std::move(encoded.levels)};
}

std::string error_text(MapKind kind, const MapTextureLevel& level) {
    const ErrorStats& error = level.error;
    if (error.count == 0) return "error not measured";
    const int digits = are_normals(kind) ? 3 : 2;
    std::string margin, share;
    if (level.confidence) {
        margin = fmt::format(" +- {:.{}f}", level.confidence->rms_margin, digits);
        share = fmt::format(", exceeded in at most {:.2g} % of the blocks",
                            100.0 * level.confidence->share_above_max);
    }
    const std::string psnr = error.psnr ? fmt::format(", PSNR {:.1f} dB", *error.psnr) : "";
    return fmt::format("error {:.{}f}{} {} RMS (99 %: {:.{}f}, maximum: {:.{}f}{}){}", error.rms,
                       digits, margin, are_normals(kind) ? "degrees" : "codes of 8 bits", error.p99,
                       digits, error.max, digits, share, psnr);
}

void add_confidence(Json& json, const SampleConfidence& confidence) {
    json.update({{"mean_margin", confidence.mean_margin},
                 {"rms_margin", confidence.rms_margin},
                 {"share_above_max", confidence.share_above_max}});
}

std::string format_text(const GpuTexture& header) {
    return fmt::format("{}, {}", enum_name(header.format), header.is_srgb ? "sRGB" : "linear");
}

Json json_of(const WrittenTexture& texture) {
    const char* const unit = are_normals(texture.kind) ? "degrees" : "codes of 8 bits";
    Json levels = json_list(texture.levels, [](const MapTextureLevel& level) {
        Json json = {{"width", level.width},
                     {"height", level.height},
                     {"rms", level.error.rms},
                     {"p99", level.error.p99},
                     {"max", level.error.max}};
        if (level.error.count == 0) json = {{"width", level.width}, {"height", level.height}};
        if (level.confidence) add_confidence(json, *level.confidence);
        if (level.error.psnr) json["psnr"] = *level.error.psnr;
        return json;
    });
    return {{"file", texture.file.string()},
            {"kind", enum_name(texture.kind)},
            {"texture_format", enum_name(texture.header.format)},
            {"color_space", texture.header.is_srgb ? "sRGB" : "linear"},
            {"width", texture.header.width},
            {"height", texture.header.height},
            {"bytes", std::filesystem::file_size(texture.file)},
            {"error_unit", unit},
            {"levels", std::move(levels)}};
}

}  // namespace relief::tools
