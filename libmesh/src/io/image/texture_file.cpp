// SPDX-License-Identifier: Apache-2.0
// Textures: encodes and decodes levels, reads and writes DDS files, and chooses between KTX2
// (ktx2_file.cpp) and DDS.
//
// A DDS file is a header of 128 bytes, for most formats here another one of 20 bytes ("DX10") with
// a number of DXGI_FORMAT, and the levels from the largest. Source: [DDS].
#include "relief/mesh/texture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "file_replacement.h"
#include "files.h"
#include "image/half_float.h"
#include "image/normal_coding.h"
#include "image/texel_loops.h"
#include "io/image/row_codec.h"
#include "io/image/texture_container.h"
#include "large_memory.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

using Bytes = std::span<const std::byte>;

/// The properties of a format: bytes of a texel or a block.
struct FormatTraits {
    TextureFormat format;
    int channels;
    int bits;
    std::optional<BlockFormat> blocks;
    bool is_half;
    std::uint32_t dxgi;
    std::uint32_t dxgi_srgb;  ///< 0 if there is none.
};

constexpr FormatTraits all_traits[] = {
    {TextureFormat::r8, 1, 8, {}, false, 61, 0},
    {TextureFormat::rg8, 2, 8, {}, false, 49, 0},
    {TextureFormat::rgba8, 4, 8, {}, false, 28, 29},
    {TextureFormat::r16, 1, 16, {}, false, 56, 0},
    {TextureFormat::rg16, 2, 16, {}, false, 35, 0},
    {TextureFormat::rgba16, 4, 16, {}, false, 11, 0},
    {TextureFormat::r16f, 1, 32, {}, true, 54, 0},
    {TextureFormat::rg16f, 2, 32, {}, true, 34, 0},
    {TextureFormat::rgba16f, 4, 32, {}, true, 10, 0},
    {TextureFormat::r32f, 1, 32, {}, false, 41, 0},
    {TextureFormat::rg32f, 2, 32, {}, false, 16, 0},
    {TextureFormat::rgba32f, 4, 32, {}, false, 2, 0},
    {TextureFormat::bc4, 1, 16, BlockFormat::bc4, false, 80, 0},
    {TextureFormat::bc4_snorm, 1, 16, BlockFormat::bc4_snorm, false, 81, 0},
    {TextureFormat::bc5, 2, 16, BlockFormat::bc5, false, 83, 0},
    {TextureFormat::bc5_snorm, 2, 16, BlockFormat::bc5_snorm, false, 84, 0},
    {TextureFormat::bc7, 4, 8, BlockFormat::bc7, false, 98, 99},
    // DXGI does not distinguish both formats of BC1: alpha that is stated as opaque does.
    {TextureFormat::bc1a, 4, 8, BlockFormat::bc1a, false, 71, 72},
    {TextureFormat::bc1, 3, 8, BlockFormat::bc1, false, 71, 72},
    {TextureFormat::bc3, 4, 8, BlockFormat::bc3, false, 77, 78},
    {TextureFormat::bc6h, 3, 32, BlockFormat::bc6h, false, 95, 0},
    {TextureFormat::bc6h_sfloat, 3, 32, BlockFormat::bc6h_sfloat, false, 96, 0},
};

const FormatTraits& traits_of(TextureFormat format) {
    return *std::find_if(std::begin(all_traits), std::end(all_traits),
                         [&](const FormatTraits& traits) { return traits.format == format; });
}

// Levels of texels that are stored one by one.

/// Copies samples; three channels get an alpha of 1.
template <typename Sample, typename Stored, typename Convert>
void encode_samples_to(const ImageView& image, std::size_t channels, Stored opaque,
                       std::byte* bytes, const Convert& convert) {
    const auto held = static_cast<std::size_t>(image.channels);
    for (int y = 0; y < image.height; ++y) {
        const Sample* const row = image.row<Sample>(y);
        for (std::size_t x = 0; x < static_cast<std::size_t>(image.width); ++x) {
            for (std::size_t c = 0; c < channels; ++c, bytes += sizeof(Stored)) {
                const Stored stored =
                    c < held
                        ? convert(row[x * held + c], static_cast<std::size_t>(y) *
                                                             static_cast<std::size_t>(image.width) +
                                                         x)
                        : opaque;
                std::memcpy(bytes, &stored, sizeof stored);
            }
        }
    }
}

std::vector<std::byte> encode_plain(const ImageView& image, const FormatTraits& traits,
                                    Report& report) {
    std::vector<std::byte> bytes(texture_level_size(traits.format, image.width, image.height));
    const auto channels = static_cast<std::size_t>(traits.channels);
    const auto same = [](auto sample, std::size_t) { return sample; };
    if (traits.is_half) {
        encode_samples_to<float, std::uint16_t>(
            image, channels, 0x3C00U, bytes.data(), [&](float sample, std::size_t texel) {
                bool is_clamped = false;
                const std::uint16_t half = half_from_float(sample, is_clamped);
                if (is_clamped) {
                    report.add("texel beyond half's range", "texel", texel,
                               fmt::format("stored as +-{}", largest_half));
                }
                return half;
            });
    } else if (traits.bits == 8) {
        encode_samples_to<std::uint8_t, std::uint8_t>(image, channels, 255, bytes.data(), same);
    } else if (traits.bits == 16) {
        encode_samples_to<std::uint16_t, std::uint16_t>(image, channels, 65535, bytes.data(), same);
    } else {
        encode_samples_to<float, float>(image, channels, 1.0F, bytes.data(), same);
    }
    return bytes;
}

Image decode_plain(Bytes bytes, const FormatTraits& traits, int width, int height) {
    Image image = make_image(width, height, traits.channels, traits.bits, ColorSpace::data);
    if (traits.is_half) {
        const std::span<float> samples = image.as<float>();
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = float_from_half(little<std::uint16_t>(bytes, 2 * i));
        return image;
    }
    std::visit([&](auto& samples) { std::memcpy(samples.data(), bytes.data(), bytes.size()); },
               image.samples);
    return image;
}

// DDS.

constexpr std::size_t dds_header_bytes = 128;
constexpr std::size_t dx10_header_bytes = 20;

namespace dds {
constexpr std::uint32_t has_caps = 0x1, has_height = 0x2, has_width = 0x4, has_pitch = 0x8,
                        has_format = 0x1000, has_levels = 0x20000, has_linear_size = 0x80000,
                        has_depth = 0x800000;
constexpr std::uint32_t four_letters = 0x4;
constexpr std::uint32_t is_complex = 0x8, is_texture = 0x1000, has_mipmaps = 0x400000;
constexpr std::uint32_t is_cube = 0x200, is_volume = 0x200000;
constexpr std::uint32_t dimension_2d = 3, misc_cube = 4;
/// The meaning of alpha: 0 is unknown.
constexpr std::uint32_t alpha_mask = 7, alpha_is_opaque = 3;
}  // namespace dds

struct DdsFormat {
    TextureFormat format;
    bool is_srgb;
};

std::optional<DdsFormat> format_of_dxgi(std::uint32_t number) {
    for (const FormatTraits& traits : all_traits) {
        if (traits.dxgi == number) return DdsFormat{traits.format, false};
        if (traits.dxgi_srgb != 0 && traits.dxgi_srgb == number)
            return DdsFormat{traits.format, true};
    }
    return std::nullopt;
}

std::optional<DdsFormat> format_of_letters(std::string_view letters) {
    if (letters == "ATI1" || letters == "BC4U") return DdsFormat{TextureFormat::bc4, false};
    if (letters == "BC4S") return DdsFormat{TextureFormat::bc4_snorm, false};
    if (letters == "ATI2" || letters == "BC5U") return DdsFormat{TextureFormat::bc5, false};
    if (letters == "BC5S") return DdsFormat{TextureFormat::bc5_snorm, false};
    return std::nullopt;
}

void check_texture(const GpuTexture& texture) {
    if (texture.width < 1 || texture.height < 1) {
        throw InvalidInput(
            fmt::format("a texture of {} x {} texels is empty", texture.width, texture.height));
    }
    std::size_t most = 1;
    while (std::max(texture.width, texture.height) >> most > 0)
        ++most;
    if (texture.levels.empty() || texture.levels.size() > most) {
        throw InvalidInput(fmt::format("a texture of {} x {} texels has 1 to {} levels, not {}",
                                       texture.width, texture.height, most, texture.levels.size()));
    }
    for (std::size_t i = 0; i < texture.levels.size(); ++i) {
        const std::size_t size = texture_level_size(texture.format, level_side(texture.width, i),
                                                    level_side(texture.height, i));
        if (texture.levels[i].size() != size) {
            throw InvalidInput(fmt::format("level {} of the texture has {} bytes, not {}", i,
                                           texture.levels[i].size(), size));
        }
    }
}

bool is_texture_extension(const std::string& extension) {
    return extension == ".ktx2" || extension == ".dds";
}

}  // namespace

int detail::level_side(int side, std::size_t level) {
    return std::max(1, side >> std::min<std::size_t>(level, 31));
}

int channels_of(TextureFormat format) {
    return traits_of(format).channels;
}

std::optional<BlockFormat> block_format_of(TextureFormat format) {
    return traits_of(format).blocks;
}

int bits_of(TextureFormat format) {
    return traits_of(format).bits;
}

bool has_srgb_variant(TextureFormat format) {
    return traits_of(format).dxgi_srgb != 0;
}

std::size_t texture_level_size(TextureFormat format, int width, int height) {
    const FormatTraits& traits = traits_of(format);
    if (traits.blocks) return block_data_size(*traits.blocks, width, height);
    const int bits = traits.is_half ? 16 : traits.bits;
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(traits.channels * bits / 8);
}

std::vector<std::byte> encode_texture_level(const ImageView& image, TextureFormat format,
                                            BlockQuality quality, Report& report) {
    const FormatTraits& traits = traits_of(format);
    if (image.empty()) throw InvalidInput("the image of a texture level is empty");
    if (traits.blocks) return encode_blocks(image, *traits.blocks, quality, report);
    const bool has_channels =
        image.channels == traits.channels || (traits.channels == 4 && image.channels == 3);
    if (!has_channels || image.bits() != traits.bits) {
        throw InvalidInput(fmt::format("{} has {} channels of {} bits, not {} of {}",
                                       enum_name(format), traits.channels, traits.bits,
                                       image.channels, image.bits()));
    }
    return encode_plain(image, traits, report);
}

Image decode_texture_level(const GpuTexture& texture, std::size_t level) {
    if (level >= texture.levels.size()) {
        throw InvalidInput(
            fmt::format("there is no level {} in a texture of {}", level, texture.levels.size()));
    }
    const FormatTraits& traits = traits_of(texture.format);
    const int width = level_side(texture.width, level);
    const int height = level_side(texture.height, level);
    const Bytes bytes = texture.levels[level];
    if (bytes.size() != texture_level_size(texture.format, width, height)) {
        throw InvalidInput(fmt::format("level {} of the texture has {} bytes, not {}", level,
                                       bytes.size(),
                                       texture_level_size(texture.format, width, height)));
    }
    if (traits.blocks) return decode_blocks(bytes, *traits.blocks, width, height);
    return decode_plain(bytes, traits, width, height);
}

/// The codes of signed formats are those of FlatCode::middle.
ImageInfo detail::image_info_of(const GpuTexture& header) {
    const FormatTraits& traits = traits_of(header.format);
    ImageInfo info{header.width, header.height, traits.channels, traits.bits, header.metadata};
    if (traits.blocks && is_signed(*traits.blocks)) info.metadata["relief:flat"] = "32768";
    return info;
}

std::optional<TextureContainer> detail::open_dds(Bytes bytes, const std::filesystem::path& name) {
    if (bytes.size() < dds_header_bytes) throw FileError(name, "is cut short within its header");
    const auto number = [&](std::size_t offset) { return little<std::uint32_t>(bytes, offset); };
    if ((number(80) & dds::four_letters) == 0) return std::nullopt;
    const std::string_view letters = text_of(bytes).substr(84, 4);
    const bool is_dx10 = letters == "DX10";
    const std::size_t start = dds_header_bytes + (is_dx10 ? dx10_header_bytes : 0);
    if (bytes.size() < start) throw FileError(name, "is cut short within its header");
    const std::optional<DdsFormat> format =
        is_dx10 ? format_of_dxgi(number(dds_header_bytes)) : format_of_letters(letters);
    if (!format) return std::nullopt;
    if (number(4) != 124) throw FileError(name, "has no DDS header of 124 bytes");
    const bool is_cube = (number(112) & dds::is_cube) != 0 ||
                         (is_dx10 && (number(dds_header_bytes + 8) & dds::misc_cube) != 0);
    const bool is_flat = (number(112) & dds::is_volume) == 0 &&
                         (!is_dx10 || number(dds_header_bytes + 4) == dds::dimension_2d);
    if (is_cube) throw FileError(name, "is a cube map, but only single images are read");
    if (!is_flat) throw FileError(name, "is not a two-dimensional texture");
    if (is_dx10 && number(dds_header_bytes + 12) > 1) {
        throw FileError(name, fmt::format("is an array of {} textures, but only single images are "
                                          "read",
                                          number(dds_header_bytes + 12)));
    }
    constexpr std::uint32_t max_side = std::uint32_t{1} << 30;
    const std::uint32_t height = number(12);
    const std::uint32_t width = number(16);
    if (width < 1 || height < 1 || width > max_side || height > max_side)
        throw FileError(name, fmt::format("announces {} x {} texels", width, height));
    TextureContainer container;
    container.header.format = format->format;
    container.header.is_srgb = format->is_srgb;
    const bool is_opaque =
        is_dx10 && (number(dds_header_bytes + 16) & dds::alpha_mask) == dds::alpha_is_opaque;
    if (format->format == TextureFormat::bc1a && is_opaque)
        container.header.format = TextureFormat::bc1;
    container.header.width = static_cast<int>(width);
    container.header.height = static_cast<int>(height);
    require_image_fits(image_info_of(container.header), name);
    const std::uint32_t stored_levels = (number(8) & dds::has_levels) != 0 ? number(28) : 1;
    const std::uint32_t levels = std::max(stored_levels, 1U);
    if (levels > 31 || std::max(width, height) >> (levels - 1) == 0) {
        throw FileError(
            name, fmt::format("announces {} mip levels of {} x {} texels", levels, width, height));
    }
    std::uint64_t offset = start;
    for (std::size_t level = 0; level < levels; ++level) {
        const std::size_t size =
            texture_level_size(format->format, level_side(container.header.width, level),
                               level_side(container.header.height, level));
        if (size > bytes.size() - offset) {
            throw FileError(name, fmt::format("is cut short: level {} needs {} bytes, but only {} "
                                              "are left of {}",
                                              level, size, bytes.size() - offset, bytes.size()));
        }
        container.levels.push_back({offset, size});
        offset += size;
    }
    return container;
}

std::vector<std::byte> detail::dds_bytes(const GpuTexture& texture) {
    const FormatTraits& traits = traits_of(texture.format);
    if (texture.is_srgb && traits.dxgi_srgb == 0) {
        throw InvalidInput(fmt::format("DDS has no sRGB variant of {}", enum_name(texture.format)));
    }
    const bool has_mips = texture.levels.size() > 1;
    const bool has_blocks = traits.blocks.has_value();
    std::vector<std::byte> bytes;
    const auto put = [&](std::uint32_t value) { append_little(bytes, value); };
    put(0x20534444);  // "DDS "
    put(124);
    put(dds::has_caps | dds::has_height | dds::has_width | dds::has_format |
        (has_blocks ? dds::has_linear_size : dds::has_pitch) | (has_mips ? dds::has_levels : 0));
    put(static_cast<std::uint32_t>(texture.height));
    put(static_cast<std::uint32_t>(texture.width));
    put(static_cast<std::uint32_t>(
        texture_level_size(texture.format, texture.width, has_blocks ? texture.height : 1)));
    put(1);  // Depth.
    put(static_cast<std::uint32_t>(texture.levels.size()));
    for (int i = 0; i < 11; ++i)
        put(0);
    put(32);
    put(dds::four_letters);
    put(0x30315844);  // "DX10"
    for (int i = 0; i < 5; ++i)
        put(0);
    put(dds::is_texture | (has_mips ? dds::is_complex | dds::has_mipmaps : 0));
    for (int i = 0; i < 4; ++i)
        put(0);
    put(texture.is_srgb ? traits.dxgi_srgb : traits.dxgi);
    put(dds::dimension_2d);
    put(0);
    put(1);  // Textures in the array.
    put(texture.format == TextureFormat::bc1 ? dds::alpha_is_opaque : 0);
    for (const std::vector<std::byte>& level : texture.levels)
        bytes.insert(bytes.end(), level.begin(), level.end());
    return bytes;
}

Image detail::read_largest_level(const TextureContainer& container, Bytes bytes,
                                 const std::filesystem::path& name) {
    require_image_fits(image_info_of(container.header), name);
    GpuTexture texture = container.header;
    texture.levels.push_back(load_level(container, bytes, 0, name));
    return decode_texture_level(texture, 0);
}

void write_texture(const std::filesystem::path& file, const GpuTexture& texture,
                   const TextureWriteOptions& options, Report& report) {
    const std::string extension = lower_extension(file);
    if (!is_texture_extension(extension))
        throw FileError(
            file, fmt::format("textures are written to .ktx2 and .dds, not to '{}'", extension));
    check_texture(texture);
    if (extension == ".dds" && options.zstd_level)
        throw InvalidInput("zstd compresses the levels of KTX2 files, not of DDS files");
    if (extension == ".dds") {
        replace_file(file, dds_bytes(texture));
        report_lost_entries(texture, report);
        return;
    }
    FileReplacement replacement(file);
    std::ofstream stream(replacement.written_path(), std::ios::binary);
    write_ktx2(texture, options, [&](Bytes part) {
        stream.write(reinterpret_cast<const char*>(part.data()),
                     static_cast<std::streamsize>(part.size()));
    });
    stream.close();
    if (!stream) throw FileError(file, "cannot be written");
    replacement.commit();
}

void detail::report_lost_entries(const GpuTexture& texture, Report& report) {
    if (texture.metadata.empty()) return;
    std::string entries;
    for (const auto& [key, text] : texture.metadata)
        entries += fmt::format("{}{} '{}'", entries.empty() ? "" : ", ", key, text);
    report.add(fmt::format("metadata that DDS cannot hold: {}", entries), "file", 0,
               "are lost (write .ktx2 to keep them)");
}

GpuTexture read_texture(Bytes bytes, const std::string& name) {
    std::optional<TextureContainer> container;
    if (text_of(bytes).starts_with("DDS "))
        container = open_dds(bytes, name);
    else
        container = open_ktx2(bytes, name);
    if (!container)
        throw FileError(name, "has a DDS format that is read as an image only, by OpenImageIO");
    GpuTexture texture = std::move(container->header);
    for (std::size_t level = 0; level < container->levels.size(); ++level) {
        container->header = {
            texture.format, texture.is_srgb, texture.width, texture.height, {}, {}, {}};
        texture.levels.push_back(load_level(*container, bytes, level, name));
    }
    return texture;
}

Image with_rebuilt_z(const Image& map, FlatCode flat, Report& report) {
    if (map.empty() || map.channels != 2)
        throw InvalidInput(fmt::format("x and y have 2 channels, not {}", map.channels));
    Image result = make_image(map.width, map.height, 3, map.bits(), map.color_space);
    with_sample_type(map, [&]<typename Sample>(Sample) {
        const NormalCoding<Sample> coding{flat};
        const std::span<const Sample> from = map.as<Sample>();
        const std::span<Sample> to = result.as<Sample>();
        for_each_texel(from.size() / 2, report, [&](std::size_t texel, Report& found) {
            const double x = coding.decoded(from[2 * texel]);
            const double y = coding.decoded(from[2 * texel + 1]);
            const double rest = 1.0 - x * x - y * y;
            if (!(rest >= 0.0)) found.add("x and y longer than 1", "texel", texel, "z becomes 0");
            to[3 * texel] = from[2 * texel];
            to[3 * texel + 1] = from[2 * texel + 1];
            to[3 * texel + 2] = coding.encoded(rest > 0.0 ? std::sqrt(rest) : 0.0);
        });
    });
    return result;
}

Image read_normal_map_image(const std::filesystem::path& file, Report& report) {
    Image image = read_image(file, ImageUse::data);
    if (image.channels != 2 || !is_texture_extension(lower_extension(file))) return image;
    const std::map<std::string, std::string> metadata = read_image_info(file).metadata;
    const std::optional<FlatCode> flat = read_description(metadata).flat;
    return with_rebuilt_z(image, flat.value_or(FlatCode::half), report);
}

GpuTexture read_texture(const std::filesystem::path& file) {
    const std::string contents = read_file(file);
    return read_texture(std::as_bytes(std::span(contents)), file.string());
}

}  // namespace relief
