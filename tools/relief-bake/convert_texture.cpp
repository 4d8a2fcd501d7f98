// SPDX-License-Identifier: Apache-2.0
// Textures of `relief-bake convert`: their options, the choice of format and quality, and the
// encoding of levels with their errors. Tests: tests/tools/relief_bake_texture_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "common/options.h"
#include "convert.h"
#include "map_textures.h"
#include "relief/mesh/block_compression.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_texture.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/image_compare.h"

namespace relief::tools {
namespace {

/// The encodings that --max-error tries, the smallest and fastest first.
constexpr TextureEncoding tried_encodings[] = {{TextureFormat::bc5, BlockQuality::fast},
                                               {TextureFormat::bc5, BlockQuality::normal},
                                               {TextureFormat::bc5, BlockQuality::best},
                                               {TextureFormat::rg8, BlockQuality::normal},
                                               {TextureFormat::rg16, BlockQuality::normal}};

/// The codes of components in the samples of a format.
NormalMapFormat normal_format_of(TextureFormat format) {
    const std::optional<BlockFormat> blocks = block_format_of(format);
    const bool has_sign = blocks && is_signed(*blocks);
    return {.bits = bits_of(format),
            .green = Green::up,
            .flat = has_sign ? FlatCode::middle : FlatCode::half,
            .dither = Dither::none};
}

/// Decodes the normals of a level of a texture.
Image normals_of(const Image& level, FlatCode flat, Green green) {
    if (level.channels == 2) return decode_xy_map(level, {0, 1}, green, flat);
    return decode_normal_map(level, green, flat);
}

ErrorStats error_of(const Image& exact, const Image& result) {
    return shade::angle_difference(exact, result).angles;
}

}  // namespace

void add_texture_options(CLI::App& app, TextureOptions& options) {
    const std::string group = "Textures (.ktx2 and .dds)";
    add_choice(app, "--format", options.format, texture_format_choices(),
               "Format of the texels. Normals: bc5 (8 bits per texel, x and y only, as engines "
               "read it), bc5-snorm (the same with signed codes, flat is exact), bc7 (with z and "
               "alpha), rg8, rgba8, rg16, rgba16, rg16f or rgba16f (not compressed). Colors: bc7, "
               "bc1 (4 bits, no alpha), bc1a (alpha of 0 or 1), bc3 or rgba8. Packed maps: bc7, "
               "bc1, bc3 or rgba8. Emission: also rgba16f, or bc6h (light above 1, 8 bits per "
               "texel). Maps of one value: bc4, r8, r16 or r16f, heights also bc6h or bc6h-sfloat "
               "(with a sign). --mips stores all levels in the file. Default: the first one.")
        .group(group);
    add_choice(app, "--quality", options.quality, enum_choices<BlockQuality>(),
               "Search for block formats: fast, normal or best. Default: normal.")
        .group(group);
    add_choice(app, "--measure", options.measuring, measuring_words,
               "The errors of all levels: in random blocks of 4 x 4 texels, at most 4096 of a "
               "level, with the confidence of the mean (quick); of all texels (full); or none. "
               "Default: quick.")
        .group(group);
    add_error_bound(
        app, options.bound, group,
        "Choose the smallest and fastest of bc5, rg8 and rg16, and the quality, whose error is at "
        "most DEG degrees in the largest level. --format or --quality limit the choice.");
    add_value(app, "--zstd", "LEVEL",
              "Compress .ktx2 with zstd, from 1 (fast) to 22 (small). Default: not compressed.",
              [&](const std::string& subject, const std::string& text) {
                  options.zstd_level = parse_integer(subject, text, 1, 22);
              })
        .group(group);
}

void check_texture_options(const CLI::App& app, const ConvertRequest& request,
                           const std::filesystem::path& output) {
    if (!is_texture(output)) {
        refuse_given(
            app,
            {"--format", "--quality", "--max-error", "--max-error-kind", "--measure", "--zstd"},
            "an output file .ktx2 or .dds");
        return;
    }
    check(request.texture.bound);
    const MapOutputOptions& given = request.output;
    if (given.bits || given.half)
        throw UsageError("--bits, --half: --format sets the bits of textures");
    if (given.flat || given.dither)
        throw UsageError("--zero-code, --dither: have no effect on textures");
    if (given.fast || given.small)
        throw UsageError("--fast, --small: --quality and --zstd set the effort for textures");
    if (request.mips.lengths) throw UsageError("--mip-lengths: textures store no lengths");
    if (request.texture.zstd_level && extension_of(output) == ".dds")
        throw UsageError("--zstd: compresses .ktx2 files only");
    const std::optional<TextureFormat> format = request.texture.format;
    const bool holds_values = request.values.kind && !are_normals(*request.values.kind);
    const auto normal_formats = find_map_texture_kind(MapKind::normal)->formats;
    if (format && !holds_values && std::ranges::count(normal_formats, *format) == 0) {
        throw UsageError(fmt::format("--format {}: does not store normals", enum_name(*format)),
                         "give --kind with the kind of the map, or another format");
    }
    if (request.texture.quality && format && !block_format_of(*format)) {
        throw UsageError(
            fmt::format("--quality: has no effect on {}, which has no blocks", enum_name(*format)));
    }
}

std::size_t TextureOptions::measured_texels() const {
    switch (measuring.value_or(Measuring::quick)) {
        case Measuring::none:
            return 0;
        case Measuring::full:
            return std::numeric_limits<std::size_t>::max();
        case Measuring::quick:
            break;
    }
    return default_measured_texels;
}

std::string level_text(std::size_t level, const LevelError& error) {
    std::string margin, share;
    if (error.confidence) {
        margin = fmt::format(" +- {:.3f}", error.confidence->mean_margin);
        share = fmt::format(", exceeded in at most {:.2g} % of the blocks",
                            100.0 * error.confidence->share_above_max);
    }
    return fmt::format(
        "level {}, {} x {}: mean error {:.3f}{} degrees (99 %: {:.3f}, maximum: {:.3f}{})", level,
        error.width, error.height, error.error.mean, margin, error.error.p99, error.error.max,
        share);
}

ExactMap read_exact_map(const std::filesystem::path& file, const AssumedKinds& assumed) {
    MapInputOptions conventions;
    conventions.assumed = assumed;
    const InputMap map = read_normal_map(file, conventions);
    return {file,
            decode_normal_map(map.image, map.green.value_or(Green::up), map.flat, IgnoredReport(),
                              FlatTexels::exact),
            map.green};
}

namespace {

/// The decoded levels of a texture or a map.
struct DecodedLevels {
    std::vector<Image> normals;
    std::optional<Green> green;  ///< Absent: unknown, and read as up.
};

DecodedLevels decoded_levels(const std::filesystem::path& file, const MapInputOptions& input) {
    DecodedLevels levels;
    if (is_texture(file)) {
        const GpuTexture texture = read_texture(file);
        check_stated_kind({file, input.accepted, texture.metadata}, input.assumed);
        const MapDescription stated = read_description(texture.metadata);
        levels.green = input.green ? input.green : stated.green;
        if (input.detects_green) levels.green = read_normal_map(file, input).green;
        const FlatCode flat =
            input.flat.value_or(stated.flat.value_or(normal_format_of(texture.format).flat));
        for (std::size_t i = 0; i < texture.levels.size(); ++i) {
            levels.normals.push_back(normals_of(decode_texture_level(texture, i), flat,
                                                levels.green.value_or(Green::up)));
        }
        return levels;
    }
    const InputMap map = read_normal_map(file, input);
    levels.green = map.green;
    levels.normals.push_back(decode_normal_map(map.image, map.green.value_or(Green::up), map.flat));
    return levels;
}

Image with_inverted_green(Image normals) {
    map_normal_axes(normals, {{{0, false}, {1, true}, {2, false}}});
    return normals;
}

}  // namespace

ExactComparison compare_levels(const std::filesystem::path& file, const ExactMap& exact,
                               const MapInputOptions& input) {
    DecodedLevels levels = decoded_levels(file, input);
    const Image& largest = levels.normals.front();
    if (largest.width != exact.normals.width || largest.height != exact.normals.height) {
        throw failure(
            file,
            fmt::format("has {} x {} texels, but {} has {} x {}", largest.width, largest.height,
                        exact.file.string(), exact.normals.width, exact.normals.height),
            "compare maps of the same size");
    }
    ExactComparison result;
    Image inverted;
    if (!exact.green || !levels.green) {
        // A texture has the green of its exact map, or the inverted one.
        inverted = with_inverted_green(exact.normals);
        const bool fits_inverted =
            error_of(inverted, largest).mean < error_of(exact.normals, largest).mean;
        const bool is_one_known = exact.green || levels.green;
        result.inverts_exact = fits_inverted && is_one_known;
        result.may_be_inverted = fits_inverted && !is_one_known;
    }
    const Image& compared = result.inverts_exact ? inverted : exact.normals;
    std::vector<Image> means;
    if (levels.normals.size() > 1) means = normal_mip_levels(compared);
    for (std::size_t i = 0; i < levels.normals.size(); ++i) {
        const Image& level = levels.normals[i];
        const Image& of_level = i == 0 ? compared : means[i - 1];
        result.levels.push_back({level.width, level.height, error_of(of_level, level), {}});
    }
    return result;
}

TextureEncoding choose_encoding(const TextureOptions& options, const Image& normals) {
    TextureEncoding encoding{options.format.value_or(TextureFormat::bc5),
                             options.quality.value_or(BlockQuality::normal)};
    if (!options.bound.degrees) return encoding;
    std::vector<TextureEncoding> tried(std::begin(tried_encodings), std::end(tried_encodings));
    if (options.format) {
        tried.clear();
        for (const auto& entry : enum_names<BlockQuality>)
            tried.push_back({*options.format, entry.value});
        if (!block_format_of(*options.format))
            tried.assign(1, {*options.format, BlockQuality::normal});
    }
    if (options.quality) {
        std::erase_if(tried, [&](const TextureEncoding& each) {
            return block_format_of(each.format) && each.quality != *options.quality;
        });
    }
    double least = 180.0;
    for (const TextureEncoding& each : tried) {
        NormalTextureEncoder encoder(normals.width, normals.height, false,
                                     {.format = each.format,
                                      .quality = each.quality,
                                      .has_mips = false,
                                      .measured_texels = std::numeric_limits<std::size_t>::max()});
        encoder.add(normals);
        const ErrorStats error = *encoder.finish().levels.front().error;
        if (options.bound.allows(error)) return each;
        least = std::min(least, options.bound.error(error));
    }
    throw UsageError(
        fmt::format("--max-error {:g}: the smallest error of the formats is {:.3g} degrees ({})",
                    *options.bound.degrees, least, statistic_name(options.bound.statistic())));
}

std::map<std::string, std::string> texture_metadata(Green green, TextureFormat format) {
    NormalMapFormat stored = normal_format_of(format);
    stored.green = green;
    return normal_map_metadata(stored);
}

}  // namespace relief::tools
