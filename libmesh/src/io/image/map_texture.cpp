// SPDX-License-Identifier: Apache-2.0
// Maps as textures: the table of kinds, mip levels by kind, encoding and measuring.
#include "relief/mesh/map_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "image/texel_loops.h"
#include "io/image/block_sample.h"
#include "io/image/texture_container.h"
#include "parallel.h"

namespace relief {
using namespace relief::detail;

namespace {

constexpr TextureFormat normal_formats[] = {
    TextureFormat::bc5,    TextureFormat::bc5_snorm, TextureFormat::bc7,
    TextureFormat::rg8,    TextureFormat::rgba8,     TextureFormat::rg16,
    TextureFormat::rgba16, TextureFormat::rg16f,     TextureFormat::rgba16f};
constexpr TextureFormat object_normal_formats[] = {TextureFormat::bc7, TextureFormat::rgba8,
                                                   TextureFormat::rgba16, TextureFormat::rgba16f};
constexpr TextureFormat color_formats[] = {TextureFormat::bc7, TextureFormat::bc1,
                                           TextureFormat::bc1a, TextureFormat::bc3,
                                           TextureFormat::rgba8};
constexpr TextureFormat emission_formats[] = {TextureFormat::bc7, TextureFormat::bc1,
                                              TextureFormat::rgba8, TextureFormat::rgba16f,
                                              TextureFormat::bc6h};
constexpr TextureFormat packed_formats[] = {TextureFormat::bc7, TextureFormat::bc1,
                                            TextureFormat::bc3, TextureFormat::rgba8};
constexpr TextureFormat value_formats[] = {TextureFormat::bc4, TextureFormat::r8,
                                           TextureFormat::r16, TextureFormat::r16f};

constexpr TextureFormat height_formats[] = {TextureFormat::bc4,  TextureFormat::r8,
                                            TextureFormat::r16,  TextureFormat::r16f,
                                            TextureFormat::bc6h, TextureFormat::bc6h_sfloat};

constexpr glm::vec3 flat_normal = {0.5F, 0.5F, 1.0F};
constexpr glm::vec3 neutral_one = {1.0F, 1.0F, 1.0F};
constexpr glm::vec3 neutral_half = {0.5F, 0.5F, 0.5F};
constexpr glm::vec3 neutral_zero = {0.0F, 0.0F, 0.0F};

constexpr MapTextureKind texture_kind_table[] = {
    {MapKind::normal, 3, false, MipFilter::normals, normal_formats, flat_normal},
    {MapKind::object_normal, 3, false, MipFilter::normals, object_normal_formats, flat_normal},
    {MapKind::height, 1, false, MipFilter::values, height_formats, neutral_half},
    {MapKind::occlusion, 1, false, MipFilter::values, value_formats, neutral_one},
    {MapKind::curvature, 1, false, MipFilter::values, value_formats, neutral_half},
    {MapKind::color, 3, true, MipFilter::colors, color_formats, neutral_one},
    {MapKind::roughness, 1, false, MipFilter::roughness, value_formats, neutral_one},
    {MapKind::packed, 3, false, MipFilter::packed, packed_formats, {1.0F, 1.0F, 0.0F}},
    {MapKind::metalness, 1, false, MipFilter::values, value_formats, neutral_zero},
    {MapKind::emission, 3, true, MipFilter::colors, emission_formats, neutral_zero}};

const MapTextureKind& kind_row(MapKind kind) {
    const MapTextureKind* const row = find_map_texture_kind(kind);
    if (row == nullptr) {
        throw InvalidInput(fmt::format("{} is not stored in textures", map_kind_info(kind).phrase));
    }
    return *row;
}

// Samples.

/// Calls each(first, last) for pieces of `count` samples in parallel.
template <typename Each>
void for_pieces(std::size_t count, Each each) {
    parallel_for(count, texels_per_piece,
                 [&](std::size_t begin, std::size_t end) { each(begin, end); });
}

/// Rounds a value from 0 to 1 to a sample.
template <typename Sample>
Sample sample_of(float value) {
    if constexpr (std::is_same_v<Sample, float>) {
        return value;
    } else {
        const float inside = value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
        constexpr auto largest = static_cast<float>(largest_sample<Sample>);
        return static_cast<Sample>(inside * largest + 0.5F);
    }
}

/// Converts channels and bits. Channels that the image lacks are 0, and alpha is 1.
Image with_layout(const Image& image, int channels, int bits) {
    if (image.channels == channels && image.bits() == bits) return image;
    Image result = make_image(image.width, image.height, channels, bits, image.color_space);
    const auto held = static_cast<std::size_t>(image.channels);
    const auto stored = static_cast<std::size_t>(channels);
    const std::size_t texels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    std::visit(
        [&]<typename From, typename To>(const std::vector<From>& from, std::vector<To>& to) {
            constexpr auto scale = static_cast<float>(1.0 / largest_sample<From>);
            for_pieces(texels, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    for (std::size_t c = 0; c < stored; ++c) {
                        const float missing = c == 3 ? 1.0F : 0.0F;
                        const float value =
                            c < held ? static_cast<float>(from[i * held + c]) * scale : missing;
                        to[i * stored + c] = sample_of<To>(value);
                    }
                }
            });
        },
        image.samples, result.samples);
    return result;
}

/// Replaces a channel by values from 0 to 1.
void set_channel(Image& image, int channel, const Image& values) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::span<const float> from = values.as<float>();
    std::visit(
        [&]<typename Sample>(std::vector<Sample>& samples) {
            for (std::size_t i = 0; i < from.size(); ++i)
                samples[i * channels + static_cast<std::size_t>(channel)] =
                    sample_of<Sample>(from[i]);
        },
        image.samples);
}

// Levels.

/// Scales the alpha of a level such that as many texels as in the largest level have at least the
/// cutoff [Castano 2010].
///
/// \param coverage  the part of such texels in the largest level
void keep_coverage(Image& level, double coverage, float cutoff) {
    Image alpha = channel_of(level, 3);
    const std::span<float> values = alpha.as<float>();
    std::vector<float> sorted(values.begin(), values.end());
    const auto wanted =
        static_cast<std::size_t>(coverage * static_cast<double>(sorted.size()) + 0.5);
    if (wanted == 0) return;
    const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(wanted - 1);
    std::nth_element(sorted.begin(), last, sorted.end(), std::greater<>());
    if (!(*last > 0.0F)) return;
    // Rounding to a code must not move the last texel below the cutoff.
    const float scale = (cutoff + 0.5F / 255.0F) / *last;
    for (float& value : values)
        value = std::min(value * scale, 1.0F);
    set_channel(level, 3, alpha);
}

double coverage_of(const Image& image, float cutoff) {
    const Image alpha = channel_of(image, 3);
    const auto values = alpha.as<float>();
    const auto inside =
        std::count_if(values.begin(), values.end(), [&](float value) { return value >= cutoff; });
    return static_cast<double>(inside) / static_cast<double>(values.size());
}

/// Returns the roughness of the levels below a map: one float channel each.
std::vector<Image> roughness_levels(const Image& map, const MapTextureOptions& options, int channel,
                                    const Image* normals, Report& report) {
    Image powers = channel_of(map, channel);
    const bool inverts = options.is_smoothness;
    for (float& value : powers.as<float>()) {
        const float roughness = inverts ? 1.0F - value : value;
        value = roughness * roughness * roughness * roughness;
    }
    std::vector<Image> levels = mip_levels(powers);
    std::vector<Image> means;
    if (normals != nullptr && normals->width == map.width && normals->height == map.height) {
        means = normal_mip_levels(*normals);
    } else if (normals != nullptr) {
        report.add("normal map of another size than the roughness", "map", 0,
                   "does not make the roughness of smaller levels larger");
    }
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::span<float> values = levels[i].as<float>();
        Image lengths;
        if (!means.empty()) lengths = split_lengths(means[i]);
        for (std::size_t t = 0; t < values.size(); ++t) {
            double variance = 0.0;
            if (!means.empty()) {
                variance = slope_variance_of_length(
                    static_cast<double>(std::as_const(lengths).as<float>()[t]));
            }
            const double sum = std::min(static_cast<double>(values[t]) + 2.0 * variance, 1.0);
            const auto roughness = static_cast<float>(std::sqrt(std::sqrt(std::max(sum, 0.0))));
            values[t] = inverts ? 1.0F - roughness : roughness;
        }
    }
    return levels;
}

std::vector<Image> levels_of(const Image& map, const MapTextureKind& kind,
                             const MapTextureOptions& options, const Image* normals,
                             Report& report) {
    switch (kind.filter) {
        case MipFilter::normals:
            return normal_mip_levels(map);
        case MipFilter::roughness:
            return roughness_levels(map, options, 0, normals, report);
        case MipFilter::packed: {
            std::vector<Image> levels = mip_levels(map);
            if (options.roughness_channel < 0) return levels;
            const std::vector<Image> roughness =
                roughness_levels(map, options, options.roughness_channel, normals, report);
            for (std::size_t i = 0; i < levels.size(); ++i)
                set_channel(levels[i], options.roughness_channel, roughness[i]);
            return levels;
        }
        case MipFilter::colors: {
            std::vector<Image> levels = mip_levels(map);
            if (!options.alpha_cutoff || map.channels < 4) return levels;
            const double coverage = coverage_of(map, *options.alpha_cutoff);
            for (Image& level : levels)
                keep_coverage(level, coverage, *options.alpha_cutoff);
            return levels;
        }
        case MipFilter::values:
            break;
    }
    return mip_levels(map);
}

// Errors.

/// Returns the errors of the texels of some blocks of a row. \param row  of blocks
/// \param is_light  whether floats are linear colors, which are compared sRGB-coded
BlockErrors value_errors(const Image& exact, std::size_t row, const EncodedRow& encoded,
                         std::span<const std::size_t> columns, bool is_light) {
    const Image decoded = decoded_columns(encoded, columns);
    const auto compared_value = [&](auto sample, std::size_t channel) {
        if constexpr (std::is_same_v<decltype(sample), float>) {
            if (is_light && channel < 3) return static_cast<double>(srgb_from_linear(sample));
        }
        return static_cast<double>(sample);
    };
    const std::size_t start = 4 * row * static_cast<std::size_t>(exact.width);
    const auto exact_channels = static_cast<std::size_t>(exact.channels);
    const auto decoded_channels = static_cast<std::size_t>(decoded.channels);
    const std::size_t compared = std::min(exact_channels, decoded_channels);
    return std::visit(
        [&]<typename A, typename B>(const std::vector<A>& a, const std::vector<B>& b) {
            constexpr double a_scale = 255.0 / largest_sample<A>;
            constexpr double b_scale = 255.0 / largest_sample<B>;
            return block_errors(encoded, columns, [&](std::size_t texel, std::size_t of_level) {
                double sum = 0.0;
                for (std::size_t c = 0; c < compared; ++c) {
                    const double difference =
                        compared_value(a[(start + of_level) * exact_channels + c], c) * a_scale -
                        compared_value(b[texel * decoded_channels + c], c) * b_scale;
                    sum += difference * difference;
                }
                return static_cast<float>(std::sqrt(sum / static_cast<double>(compared)));
            });
        },
        exact.samples, decoded.samples);
}

MeasuredError level_error(const Image& exact, const GpuTexture& texture, std::size_t level,
                          const MapTextureKind& kind, const MapTextureOptions& options) {
    const bool are_normals = kind.filter == MipFilter::normals;
    const auto width = static_cast<std::size_t>(exact.width);
    const std::size_t row_bytes = texture_level_size(texture.format, exact.width, 4);
    const std::span<const std::byte> bytes = texture.levels[level];
    BlockSample sample(exact.width, exact.height, options.measured_texels);
    const std::size_t block_rows = (static_cast<std::size_t>(exact.height) + 3) / 4;
    sample.measure(0, block_rows, [&](std::size_t row, std::span<const std::size_t> columns) {
        const std::size_t begin = row * row_bytes;
        const EncodedRow encoded{
            texture.format, bytes.subspan(begin, std::min(row_bytes, bytes.size() - begin)),
            exact.width, std::min(4, exact.height - 4 * static_cast<int>(row))};
        if (!are_normals) return value_errors(exact, row, encoded, columns, kind.is_color);
        return normal_block_errors(encoded, columns, exact.as<float>().data() + 3 * 4 * row * width,
                                   options.green);
    });
    MeasuredError result = sample.result();
    if (!are_normals && result.error.rms > 0.0)
        result.error.psnr = 20.0 * std::log10(255.0 / result.error.rms);
    return result;
}

// Encoding.

std::vector<std::byte> encoded_normals(const Image& normals, TextureFormat format,
                                       const MapTextureOptions& options, Report& report) {
    const std::optional<BlockFormat> blocks = block_format_of(format);
    if (blocks && channels_of(*blocks) == 2) {
        return encode_normal_blocks(
            normals, {.format = *blocks, .quality = options.quality, .green = options.green},
            report);
    }
    // BC7 is encoded from the exact components, not from codes of 8 bits.
    const NormalMapFormat stored{.bits = blocks ? 32 : bits_of(format),
                                 .green = options.green,
                                 .flat = FlatCode::half,
                                 .dither = Dither::none};
    const Image codes = encode_normal_map(normals, stored, report);
    const int channels = blocks ? codes.channels : channels_of(format);
    return encode_texture_level(with_layout(codes, channels, codes.bits()), format, options.quality,
                                report);
}

std::vector<std::byte> encoded_values(const Image& values, TextureFormat format,
                                      const MapTextureOptions& options, Report& report) {
    int channels = channels_of(format);
    if (channels == 4 && values.channels == 3) channels = 3;
    // A map of one value has absolute errors.
    if (block_format_of(format) && values.channels == 1) channels = 1;
    const int bits = block_format_of(format) ? values.bits() : bits_of(format);
    return encode_texture_level(with_layout(values, channels, bits), format, options.quality,
                                report);
}

/// Chooses the format. \throws InvalidInput if it is none of the kind's
TextureFormat chosen_format(const MapTextureKind& kind, const MapTextureOptions& options) {
    if (!options.format) return kind.formats.front();
    if (std::ranges::count(kind.formats, *options.format) > 0) return *options.format;
    std::string names;
    for (const TextureFormat format : kind.formats)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", enum_name(format));
    throw InvalidInput(fmt::format("{} is not stored in {}: its formats are {}",
                                   map_kind_info(kind.kind).phrase, enum_name(*options.format),
                                   names));
}

void check_map(const Image& map, const MapTextureKind& kind, TextureFormat format) {
    if (map.empty()) throw InvalidInput("the map is empty");
    const bool may_have_alpha =
        kind.filter == MipFilter::packed || kind.filter == MipFilter::colors;
    const bool has_alpha = may_have_alpha && map.channels == kind.channels + 1;
    if (map.channels != kind.channels && !has_alpha) {
        throw InvalidInput(fmt::format("{} has {} channels, not {}",
                                       map_kind_info(kind.kind).phrase, kind.channels,
                                       map.channels));
    }
    if (kind.filter == MipFilter::normals && map.bits() != 32)
        throw InvalidInput(fmt::format("normals have float samples, not {} bits", map.bits()));
    if (has_alpha && !stores_alpha(format)) {
        throw InvalidInput(fmt::format("the map has alpha, but {} stores none", enum_name(format)));
    }
}

/// Converts linear floats of colors for formats that store sRGB codes, and sRGB codes for formats
/// that store linear floats.
Image stored_colors(const Image& map, TextureFormat format, Report& report) {
    const bool is_stored_coded = has_srgb_variant(format);
    const bool is_coded = map.bits() != 32;
    if (is_coded == is_stored_coded) return map;
    if (is_coded) {
        Image coded = map;
        coded.color_space = ColorSpace::srgb;
        return to_linear(coded);
    }
    const std::span<const float> samples = map.as<float>();
    const auto channels = static_cast<std::size_t>(map.channels);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i] > 1.0F && i % channels < 3)
            report.add("color above 1", "texel", i / channels, "is stored as 1");
    }
    Image linear = map;
    linear.color_space = ColorSpace::linear;
    return to_srgb(linear, 16);
}

std::map<std::string, std::string> description_entries(const Image& map, const MapTextureKind& kind,
                                                       TextureFormat format,
                                                       const MapTextureOptions& options) {
    MapDescription description;
    description.kind = kind.kind;
    description.color_space = ColorSpace::data;
    if (kind.is_color)
        description.color_space = has_srgb_variant(format) ? ColorSpace::srgb : ColorSpace::linear;
    if (kind.kind == MapKind::color && map.channels == 4) description.alpha = AlphaContent::opacity;
    if (kind.filter == MipFilter::normals) {
        description.flat = flat_code_of(format);
        if (kind.kind == MapKind::normal) description.green = options.green;
    }
    return write_description(description, bits_of(format));
}

}  // namespace

std::span<const MapTextureKind> map_texture_kinds() {
    return texture_kind_table;
}

const MapTextureKind* find_map_texture_kind(MapKind kind) {
    const auto* const found =
        std::find_if(std::begin(texture_kind_table), std::end(texture_kind_table),
                     [&](const auto& row) { return row.kind == kind; });
    return found == std::end(texture_kind_table) ? nullptr : found;
}

bool stores_alpha(TextureFormat format) {
    return channels_of(format) == 4;
}

std::vector<Image> map_mip_levels(const Image& map, const MapTextureOptions& options,
                                  const Image* normals, Report& report) {
    return levels_of(map, kind_row(options.kind), options, normals, report);
}

MapTexture encode_map_texture(const Image& map, const MapTextureOptions& options,
                              const Image* normals, Report& report,
                              const ExecutionOptions& execution) {
    const ExecutionScope scope(execution);
    const MapTextureKind& kind = kind_row(options.kind);
    const TextureFormat format = chosen_format(kind, options);
    check_map(map, kind, format);
    const bool are_normals = kind.filter == MipFilter::normals;
    Image largest = kind.is_color ? stored_colors(map, format, report) : map;
    if (kind.is_color && largest.bits() != 32) largest.color_space = ColorSpace::srgb;
    MapTexture result;
    GpuTexture& texture = result.texture;
    texture.format = format;
    texture.is_srgb = kind.is_color && has_srgb_variant(format);
    texture.width = map.width;
    texture.height = map.height;
    if (channels_of(format) == 2) texture.swizzle = "rg01";
    texture.metadata = description_entries(map, kind, format, options);
    const auto add = [&](const Image& level) {
        texture.levels.push_back(are_normals ? encoded_normals(level, format, options, report)
                                             : encoded_values(level, format, options, report));
        MapTextureLevel written{level.width, level.height, {}, {}};
        if (options.measured_texels > 0) {
            MeasuredError measured =
                level_error(level, texture, texture.levels.size() - 1, kind, options);
            written.error = std::move(measured.error);
            written.confidence = measured.confidence;
        }
        result.levels.push_back(std::move(written));
    };
    add(largest);
    if (!options.has_mips) return result;
    std::vector<Image> levels = levels_of(largest, kind, options, normals, report);
    largest = Image{};
    for (Image& level : levels) {
        add(level);
        level = Image{};
    }
    return result;
}

}  // namespace relief
