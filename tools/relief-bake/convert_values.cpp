// SPDX-License-Identifier: Apache-2.0
// `relief-bake convert` of maps that hold no normals, to textures: their options, conversion and
// summary. Tests: tests/tools/relief_bake_map_texture_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "common/options.h"
#include "common/summary.h"
#include "convert.h"
#include "map_textures.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"

namespace relief::tools {
namespace {

/// Reads the normals of --normals, y up.
Image read_normals(const std::filesystem::path& file, const ConvertRequest& request) {
    MapInputOptions options;
    options.assumed = request.input.assumed;
    const InputMap map = read_normal_map(file, options);
    return decode_normal_map(map.image, map.green.value_or(Green::up), map.flat, IgnoredReport(),
                             FlatTexels::exact);
}

MapTextureOptions texture_options_of(const ConvertRequest& request, MapKind kind) {
    MapTextureOptions options;
    options.kind = kind;
    options.format = request.texture.format;
    options.quality = request.texture.quality.value_or(BlockQuality::normal);
    options.has_mips = request.mips.wanted;
    options.alpha_cutoff = request.values.alpha_cutoff;
    options.measured_texels = request.texture.measured_texels();
    return options;
}

void set_packing(const std::filesystem::path& file, MapTextureOptions& options) {
    if (options.kind != MapKind::packed) return;
    if (read_description(read_image_info(file).metadata).detail != "unity") return;
    options.roughness_channel = 3;
    options.is_smoothness = true;
}

/// \throws UsageError if the format stores no alpha, or is none of the kind's
void check_format(const MapTextureOptions& options, const Image& map) {
    if (!options.format) return;
    const MapTextureKind& kind = *find_map_texture_kind(options.kind);
    if (std::ranges::count(kind.formats, *options.format) == 0) {
        std::vector<std::string_view> names;
        for (const TextureFormat format : kind.formats)
            names.push_back(enum_name(format));
        throw UsageError(fmt::format("--format {}: {} is not stored in it",
                                     enum_name(*options.format), map_kind_info(kind.kind).phrase),
                         fmt::format("choose one of {}", fmt::join(names, ", ")));
    }
    if (map.channels == 4 && !stores_alpha(*options.format)) {
        throw UsageError(fmt::format("--format {}: stores no alpha, which the map has",
                                     enum_name(*options.format)),
                         "give --alpha drop, or a format with alpha");
    }
}

}  // namespace

void add_value_options(CLI::App& app, ValueOptions& options) {
    const std::string group = "Textures (.ktx2 and .dds)";
    add_choice(app, "--kind", options.kind, texture_kind_choices(),
               "Kind of the map, which decides its formats, its color space and the filter of its "
               "mip levels. Default: from the file's metadata, else normal.")
        .group(group);
    add_choice(app, "--input-channel", options.channel,
               Choices<int>{{"r", 0}, {"g", 1}, {"b", 2}, {"a", 3}},
               "Channel to read, for kinds with one value. Default: the map must be gray.")
        .group(group);
    add_number(app, "--alpha-cutoff", "A", options.alpha_cutoff, {0.0, 1.0, ""},
               "Of colors that are cut out where alpha is below A: each mip level keeps the part "
               "of texels that are not cut out.")
        .group(group);
    add_path(app, "--normals", options.normals,
             "Of roughness and packed maps: the normal map of the surface. Its variance makes the "
             "smaller levels rougher, as its own levels become flatter.")
        .group(group);
}

std::optional<MapKind> value_kind_of(const Job& job, const ConvertRequest& request) {
    std::optional<MapKind> kind = request.values.kind;
    // --assume reads the map as normals, whatever its metadata say.
    if (!kind && is_texture(job.output) && request.input.assumed.empty()) {
        kind = read_description(read_image_info(job.input).metadata).kind;
        if (kind && find_map_texture_kind(*kind) == nullptr) kind.reset();
    }
    if (!kind || are_normals(*kind)) return std::nullopt;
    return kind;
}

void check_value_options(const CLI::App& app, const ConvertRequest& request,
                         const std::filesystem::path& output) {
    const ValueOptions& values = request.values;
    const bool is_value = values.kind && !are_normals(*values.kind);
    if (values.kind && !is_texture(output))
        throw UsageError("--kind: has no effect on images", "write .ktx2 or .dds");
    if (values.kind && !is_value) {
        refuse_given(app, {"--input-channel", "--alpha-cutoff", "--normals"},
                     "a --kind without normals");
    }
    if (!is_value) return;
    for (const char* const option :
         {"--flip", "--axes", "--rebuild-z", "--normalize", "--resize", "--strength", "--detail",
          "--to-object", "--to-tangent", "--mip-lengths", "--roughness-from-variance",
          "--input-green", "--input-zero-code", "--input-signed", "--green", "--for", "--bits",
          "--max-error"}) {
        if (!is_given(app, option)) continue;
        throw UsageError(fmt::format("{}: is for normal maps, not for --kind {}", option,
                                     enum_name(*values.kind)));
    }
    if (*values.kind != MapKind::color) refuse_given(app, {"--alpha-cutoff"}, "--kind color");
    if (*values.kind != MapKind::roughness && *values.kind != MapKind::packed)
        refuse_given(app, {"--normals"}, "--kind roughness or packed");
    if (!request.mips.wanted) refuse_given(app, {"--alpha-cutoff", "--normals"}, "--mips");
}

FileOutcome convert_values(const Job& job, const ConvertRequest& request, MapKind kind,
                           Stages& stages) {
    Report report;
    MapTextureOptions options = texture_options_of(request, kind);
    Image map = stages.run("read", [&] {
        std::vector<MapKind> accepted = {kind};
        // A channel of another map may be chosen.
        if (request.values.channel) accepted.push_back(MapKind::packed);
        if (request.values.kind) accepted.push_back(MapKind::color);
        check_kind(job.input, accepted, request.input.assumed);
        set_packing(job.input, options);
        return read_value_map(job.input, kind, request.values.channel,
                              request.alpha == AlphaChoice::keep);
    });
    check_format(options, map);
    std::optional<Image> normals;
    if (request.values.normals) {
        normals =
            stages.run("read", [&] { return read_normals(*request.values.normals, request); });
    }
    const int channels = map.channels;
    const int bits = map.bits();
    MapTexture encoded = about(job.input, [&] {
        return stages.run("convert", [&] {
            return encode_map_texture(map, options, normals ? &*normals : nullptr, report);
        });
    });
    map = Image{};
    for (const auto& [key, value] : kept_metadata(read_image_info(job.input).metadata))
        encoded.texture.metadata.emplace(key, value);
    const WrittenTexture written = stages.run("write", [&] {
        return write_map_texture(job.output, kind, std::move(encoded), request.texture.zstd_level,
                                 report);
    });
    FileOutcome outcome;
    outcome.findings.add("", report, request.mips.wanted ? 0 : written.header.width);
    Summary& summary = outcome.summary;
    summary.add("read", fmt::format("{}: {} x {}, {}, {} bit, {}", job.input.string(),
                                    written.header.width, written.header.height,
                                    counted(static_cast<std::size_t>(channels), "channel"), bits,
                                    map_kind_info(kind).phrase));
    summary.add("format", format_text(written.header));
    std::vector<std::string> lines = {file_and_size(job.output)};
    for (std::size_t i = 0; i < written.levels.size(); ++i) {
        const MapTextureLevel& level = written.levels[i];
        lines.push_back(fmt::format("level {}, {} x {}: {}", i, level.width, level.height,
                                    error_text(kind, level)));
    }
    summary.add("wrote", lines, json_of(written));
    summary.add_findings(outcome.findings);
    summary.add_times(stages);
    outcome.line =
        fmt::format("{}: {} x {}, {}, {}, {}", job.output.string(), written.header.width,
                    written.header.height, format_text(written.header),
                    error_text(kind, written.levels.front()), outcome.findings.count_text());
    return outcome;
}

}  // namespace relief::tools
