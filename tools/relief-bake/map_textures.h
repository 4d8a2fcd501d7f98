// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps of all kinds as textures: reading a map with the channels of its kind, and the text of
/// the written levels. For convert, pack and textures.
/// Tests: tests/tools/relief_bake_map_texture_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/map_texture.h"
#include "relief/mesh/report.h"

namespace relief::tools {

/// The names of all formats that some kind of map has.
Choices<TextureFormat> texture_format_choices();

/// The names of the kinds that have textures.
Choices<MapKind> texture_kind_choices();

/// Returns whether the maps of a kind are normals.
bool are_normals(MapKind kind);

/// Reads a map that holds no normals, with the channels of its kind and, for colors and packed maps
/// whose alpha is not 1 everywhere, alpha.
///
/// \param channel  of maps with one value: the one to read; absent: the map must be gray
/// \param keeps_alpha  false: alpha is left out
/// \throws FileError if the map cannot be read, or is not gray
Image read_value_map(const std::filesystem::path& file, MapKind kind, std::optional<int> channel,
                     bool keeps_alpha);

/// A written texture, for summaries.
struct WrittenTexture {
    std::filesystem::path file;
    MapKind kind = MapKind::color;
    GpuTexture header;  ///< Without levels.
    std::vector<MapTextureLevel> levels;
};

/// Writes a texture. \return what was written
WrittenTexture write_map_texture(const std::filesystem::path& file, MapKind kind,
                                 MapTexture encoded, std::optional<int> zstd_level, Report& report);

/// "mean error 0.39 degrees (99 %: 1.13, maximum: 2.45)", "error 1.2 codes RMS (99 %: 3.1, maximum:
/// 9.0), PSNR 46.5 dB"
std::string error_text(MapKind kind, const MapTextureLevel& level);

/// Adds "mean_margin", "rms_margin" and "share_above_max".
void add_confidence(Json& json, const SampleConfidence& confidence);

/// "bc7, sRGB"
std::string format_text(const GpuTexture& header);

/// "format", "color_space", "width", "height" and "levels" with their errors.
Json json_of(const WrittenTexture& texture);

}  // namespace relief::tools
