// SPDX-License-Identifier: Apache-2.0
#include "atlas_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/command.h"
#include "common/file_jobs.h"
#include "common/text.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

constexpr int max_picture_side = 2048;

std::string used_text(const AtlasStats& stats) {
    return fmt::format("{} ({} below 64 texels)", counted(stats.charts, "chart"),
                       stats.small_charts);
}

/// Returns the numbers of the first tiles: "1001, 1002, 1003".
std::string tile_text(const std::vector<int>& tiles) {
    constexpr std::size_t max_numbers = 10;
    const std::size_t shown = std::min(tiles.size(), max_numbers);
    return fmt::format("{}{}",
                       fmt::join(tiles.begin(), tiles.begin() + std::ptrdiff_t(shown), ", "),
                       shown < tiles.size() ? ", ..." : "");
}

}  // namespace

std::string mip_text(const std::optional<int>& safe_level) {
    return safe_level ? fmt::format("enough up to mip level {}", *safe_level)
                      : "too few for bilinear lookups";
}

glm::ivec2 parse_atlas_size(const std::string& subject, const std::string& text) {
    const std::size_t cross = text.find('x');
    const auto side = [&](const std::string& number) {
        return parse_integer(subject, number, 16, 65536);
    };
    if (cross == std::string::npos) return glm::ivec2(side(text));
    return {side(text.substr(0, cross)), side(text.substr(cross + 1))};
}

Json stats_json(const AtlasStats& stats) {
    return {{"charts", stats.charts},
            {"stacked_parts", stats.stacked_parts},
            {"small_charts", stats.small_charts},
            {"used", stats.used},
            {"texels_per_unit", stats.texels_per_unit},
            {"min_density", stats.min_density},
            {"max_density", stats.max_density},
            {"stretch", stats.stretch},
            {"mean_anisotropy", stats.mean_anisotropy},
            {"max_anisotropy", stats.max_anisotropy},
            {"seam_length", stats.seam_length},
            {"relative_seam_length", stats.relative_seam_length},
            {"area", stats.area},
            {"perimeter", stats.perimeter},
            {"padding_share", stats.padding_share ? Json(*stats.padding_share) : Json()},
            {"safe_mip_level", stats.safe_mip_level ? Json(*stats.safe_mip_level) : Json()}};
}

Json quality_json(const TexcoordQuality& quality) {
    return {{"atlas", stats_json(quality.stats)},
            {"tiles", quality.tiles},
            {"shared_charts", quality.shared_charts},
            {"overlapping", quality.overlapping},
            {"inverted", quality.inverted},
            {"flat", quality.flat},
            {"outside", quality.outside},
            {"mirrored_charts", quality.mirrored_charts},
            {"min_distance", quality.min_distance ? Json(*quality.min_distance) : Json()}};
}

void add_stats(Summary& summary, const AtlasStats& stats, const glm::ivec2& size, int tiles) {
    summary.add(
        "atlas",
        {fmt::format("{}, {:.1f} % of {}{} x {} texels used", used_text(stats), 100.0 * stats.used,
                     tiles == 1 ? "" : fmt::format("{} tiles of ", tiles), size.x, size.y),
         fmt::format("the padding of {} costs {:.1f} % of them", counted(stats.charts, "chart"),
                     100.0 * stats.padding_share.value_or(0.0)),
         fmt::format("seams: length {:.4g}, {:.3g} times the root of the area", stats.seam_length,
                     stats.relative_seam_length)},
        {{"atlas", stats_json(stats)}});
    summary.add("stacked",
                stats.stacked_parts == 0
                    ? ""
                    : fmt::format("{} the texels of an equal one",
                                  counted(stats.stacked_parts, "part shares", "parts share")));
    summary.add("density",
                fmt::format("{:.4g} texels per unit; 5 to 95 % of the area: {:.3f} to {:.3f} of it",
                            stats.texels_per_unit, stats.min_density, stats.max_density));
    summary.add("stretch",
                fmt::format("L2 {:.4f}; ratio of singular values: mean {:.3f}, max {:.2f}",
                            stats.stretch, stats.mean_anisotropy, stats.max_anisotropy));
}

std::string quality_text(const std::string& name, const TexcoordQuality& quality) {
    const AtlasStats& stats = quality.stats;
    std::string text = name.empty() ? "" : name + ": ";
    text += fmt::format(
        "{}, {:.1f} % used, {:.4g} texels per unit (5 to 95 %: {:.2f} to {:.2f} of it), stretch L2 "
        "{:.3f}, seams {:.3g}",
        used_text(stats), 100.0 * stats.used, stats.texels_per_unit, stats.min_density,
        stats.max_density, stats.stretch, stats.relative_seam_length);
    if (quality.tiles.size() > 1 || (quality.tiles.size() == 1 && quality.tiles[0] != 1001))
        text += fmt::format(", in {}: {}", counted(quality.tiles.size(), "tile"),
                            tile_text(quality.tiles));
    if (quality.min_distance)
        text += fmt::format(", {:.2g} texels apart ({})", *quality.min_distance,
                            mip_text(stats.safe_mip_level));
    if (quality.shared_charts > 0)
        text += fmt::format(", {} the texels of an equal one",
                            counted(quality.shared_charts, "chart shares", "charts share"));
    const auto add = [&](std::size_t count, const char* what) {
        if (count > 0) text += fmt::format(", {} {}", count, what);
    };
    add(quality.overlapping, "overlapping");
    add(quality.inverted, "inverted");
    add(quality.flat, "flat");
    add(quality.outside, "outside of the map or its tiles");
    if (quality.mirrored_charts > 0)
        text += fmt::format(", {} mirrored", counted(quality.mirrored_charts, "chart"));
    return text;
}

void add_picture_options(CLI::App& app, AtlasPictureOptions& options) {
    const std::string group = "Picture";
    add_path(app, "--picture", options.file,
             "Draw the charts in the map, at most 2048 pixels wide and high.")
        .group(group);
    add_choice<AtlasPicture>(
        app, "--picture-shows", enum_choices<AtlasPicture>(),
        "Colors of --picture: one for each chart; the density, from blue (half of the mean) to red "
        "(double); or the ratio of singular values, to red (4). Default: charts.",
        [&options](AtlasPicture picture) { options.shows = picture; })
        .group(group);
}

void check(const AtlasPictureOptions& options, const std::vector<std::filesystem::path>& files) {
    if (!options.file) {
        if (options.shows) throw UsageError("--picture-shows: has no effect without --picture");
        return;
    }
    if (extension_of(*options.file) != ".png")
        throw UsageError(
            fmt::format("--picture {}: the format is not supported", options.file->string()),
            "use .png");
    check_distinct("--picture", *options.file, files);
    require_folder_of(*options.file);
}

void write_picture(const AtlasPictureOptions& options, const Mesh& mesh,
                   std::span<const glm::vec2> corner_texcoords,
                   std::span<const std::optional<std::uint32_t>> chart, const glm::ivec2& size,
                   int tiles) {
    constexpr int tiles_in_a_row = 10;
    const glm::ivec2 grid(std::min(tiles, tiles_in_a_row),
                          (tiles + tiles_in_a_row - 1) / tiles_in_a_row);
    const glm::dvec2 all = glm::dvec2(size) * glm::dvec2(grid);
    const double scale = std::min(1.0, max_picture_side / std::max(all.x, all.y));
    const glm::ivec2 pixels = glm::max(glm::ivec2(all * scale + 0.5), glm::ivec2(1));
    // Rows of tiles go upwards, to negative v.
    std::vector<glm::vec2> shown(corner_texcoords.begin(), corner_texcoords.end());
    for (glm::vec2& texcoord : shown)
        texcoord = (texcoord + glm::vec2(0.0F, static_cast<float>(grid.y - 1))) / glm::vec2(grid);
    write_image(*options.file, draw_atlas(mesh, shown, chart, pixels,
                                          options.shows.value_or(AtlasPicture::charts)));
}

}  // namespace relief::tools
