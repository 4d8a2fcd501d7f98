// SPDX-License-Identifier: Apache-2.0
/// \file
/// Prints and draws texture coordinates, for `unwrap` and `check`.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/atlas_picture.h"
#include "relief/mesh/texcoord_quality.h"
#include "relief/mesh/unwrap.h"

namespace relief::tools {

/// Parses "2048" or "2048x1024", 16 to 65536 each.
glm::ivec2 parse_atlas_size(const std::string& subject, const std::string& text);

Json stats_json(const AtlasStats& stats);
/// The faults of given coordinates; the statistics are under "atlas".
Json quality_json(const TexcoordQuality& quality);

/// Adds the rows "atlas", "stacked", "density" and "stretch". \param tiles  of UDIM
void add_stats(Summary& summary, const AtlasStats& stats, const glm::ivec2& size, int tiles);

/// Returns "enough up to mip level 1". \param safe_level  AtlasStats::safe_mip_level
std::string mip_text(const std::optional<int>& safe_level);

/// One row of text for given coordinates. \param name  of the material, or empty
std::string quality_text(const std::string& name, const TexcoordQuality& quality);

/// The picture that a command draws, if a file is given.
struct AtlasPictureOptions {
    std::optional<std::filesystem::path> file;
    std::optional<AtlasPicture> shows;
};

void add_picture_options(CLI::App& app, AtlasPictureOptions& options);
/// Checks the options before the work. \param files  the other files of the command
void check(const AtlasPictureOptions& options, const std::vector<std::filesystem::path>& files);
/// Draws the picture: as large as the map, but at most 2048 pixels wide and high. Up to ten tiles
/// of UDIM are side by side, further ones above.
void write_picture(const AtlasPictureOptions& options, const Mesh& mesh,
                   std::span<const glm::vec2> corner_texcoords,
                   std::span<const std::optional<std::uint32_t>> chart, const glm::ivec2& size,
                   int tiles);

}  // namespace relief::tools
