// SPDX-License-Identifier: Apache-2.0
// KTX2 files: header, index of levels, data format descriptor (DFD), text entries, and levels from
// the smallest, each compressed with zstd or not. No other file uses zstd.
// Source: [KTX2], [Khronos Data Format].
#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>

#include "files.h"
#include "io/image/row_codec.h"
#include "io/image/texture_container.h"
#include "large_memory.h"
#include "memory_budget.h"
#include "progress_stage.h"
#include "relief/mesh/limits.h"
#include "relief/mesh/report.h"
#include "relief/version.h"

namespace relief::detail {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::string_view ktx2_identifier("\xABKTX 20\xBB\r\n\x1A\n", 12);
constexpr std::size_t ktx2_header_bytes = 80;
constexpr std::size_t level_entry_bytes = 24;

struct VulkanFormat {
    std::uint32_t number;
    TextureFormat format;
    bool is_srgb;
};

constexpr VulkanFormat vulkan_formats[] = {
    {9, TextureFormat::r8, false},           {15, TextureFormat::r8, true},
    {16, TextureFormat::rg8, false},         {22, TextureFormat::rg8, true},
    {37, TextureFormat::rgba8, false},       {43, TextureFormat::rgba8, true},
    {70, TextureFormat::r16, false},         {77, TextureFormat::rg16, false},
    {91, TextureFormat::rgba16, false},      {76, TextureFormat::r16f, false},
    {83, TextureFormat::rg16f, false},       {97, TextureFormat::rgba16f, false},
    {100, TextureFormat::r32f, false},       {103, TextureFormat::rg32f, false},
    {109, TextureFormat::rgba32f, false},    {139, TextureFormat::bc4, false},
    {140, TextureFormat::bc4_snorm, false},  {141, TextureFormat::bc5, false},
    {142, TextureFormat::bc5_snorm, false},  {145, TextureFormat::bc7, false},
    {146, TextureFormat::bc7, true},         {131, TextureFormat::bc1, false},
    {132, TextureFormat::bc1, true},         {133, TextureFormat::bc1a, false},
    {134, TextureFormat::bc1a, true},        {137, TextureFormat::bc3, false},
    {138, TextureFormat::bc3, true},         {143, TextureFormat::bc6h, false},
    {144, TextureFormat::bc6h_sfloat, false}};

/// "the Vulkan format 131 (BC1)"
std::string vulkan_name(std::uint32_t number) {
    struct Group {
        std::uint32_t first, last;
        const char* name;
    };
    static constexpr Group groups[] = {
        {0, 0, "Basis Universal"}, {23, 36, "RGB8"},   {131, 134, "BC1"},  {135, 136, "BC2"},
        {137, 138, "BC3"},         {143, 144, "BC6H"}, {147, 152, "ETC2"}, {153, 156, "EAC"},
        {157, 184, "ASTC"},        {84, 90, "RGB16"},  {104, 106, "RGB32"}};
    for (const Group& group : groups) {
        if (number >= group.first && number <= group.last)
            return fmt::format("the Vulkan format {} ({})", number, group.name);
    }
    return fmt::format("the Vulkan format {}", number);
}

const VulkanFormat& read_vulkan_format(std::uint32_t number, const std::filesystem::path& name) {
    for (const VulkanFormat& format : vulkan_formats) {
        if (format.number == number) return format;
    }
    throw FileError(name, fmt::format("has {}; of KTX2 files, relief reads R, RG and RGBA of 8, 16 "
                                      "and 32 bits, BC1, BC3, BC4, BC5, BC6H and BC7",
                                      vulkan_name(number)));
}

std::uint32_t vulkan_number(const GpuTexture& texture) {
    for (const VulkanFormat& format : vulkan_formats) {
        if (format.format == texture.format && format.is_srgb == texture.is_srgb)
            return format.number;
    }
    throw InvalidInput(fmt::format("there is no sRGB variant of {}", enum_name(texture.format)));
}

/// The size in bytes of what is swapped on big-endian machines.
std::uint32_t type_size(TextureFormat format) {
    if (block_format_of(format) || bits_of(format) == 8) return 1;
    const std::size_t channels = static_cast<std::size_t>(channels_of(format));
    return static_cast<std::uint32_t>(texture_level_size(format, 1, 1) / channels);
}

bool is_in_file(std::uint64_t offset, std::uint64_t length, std::uint64_t size) {
    return offset <= size && length <= size - offset;
}

/// Reads the text entries; values that are no text are left out.
void read_entries(Bytes data, const std::filesystem::path& name, GpuTexture& texture) {
    for (std::size_t at = 0; at + 4 <= data.size();) {
        const auto length = little<std::uint32_t>(data, at);
        if (length > data.size() - at - 4)
            throw FileError(name, "has a text entry that exceeds the list of entries");
        const std::string_view entry = text_of(data.subspan(at + 4, length));
        const std::size_t end = entry.find('\0');
        if (end == 0 || end == entry.npos) throw FileError(name, "has a text entry without a key");
        std::string_view value = entry.substr(end + 1);
        if (value.ends_with('\0')) value.remove_suffix(1);
        const std::string key(entry.substr(0, end));
        if (key == "KTXswizzle")
            texture.swizzle = value;
        else if (value.find('\0') == value.npos)
            texture.metadata.emplace(key, value);
        at += 4 + (static_cast<std::size_t>(length) + 3) / 4 * 4;
    }
}

/// Checks that a file stands for an image in proportion to its bytes, because zstd reaches any
/// factor. An explicit limit of pixels takes the place of this one.
void require_in_proportion(const GpuTexture& header, std::uint64_t file_bytes,
                           const std::filesystem::path& name) {
    if (input_limits().pixels > 0) return;
    const ImageInfo info = image_info_of(header);
    const std::uint64_t bytes = static_cast<std::uint64_t>(info.width) *
                                static_cast<std::uint64_t>(info.height) *
                                static_cast<std::uint64_t>(info.channels * info.bits / 8);
    const std::uint64_t limit = MemoryBudget(file_bytes).limit();
    if (bytes <= limit) return;
    throw FileError(
        name, fmt::format("announces {} x {} texels, which take {} MiB of memory, but a file of {} "
                          "bytes may take only {} (--max-memory or --max-pixels raises this limit)",
                          info.width, info.height, bytes >> 20U, file_bytes, limit >> 20U));
}

/// Checks that the bytes of a level can hold its texels. \param stored  of the compressed level
void check_compressed_size(std::uint64_t stored, std::uint64_t size, std::size_t level,
                           const std::filesystem::path& name) {
    // A block of zstd has at least 4 bytes and at most 128 KiB of contents.
    constexpr std::uint64_t most_per_byte = 1 << 15;
    if (size / most_per_byte <= stored) return;
    throw FileError(name, fmt::format("level {} announces {} bytes in {} compressed ones", level,
                                      size, stored));
}

// The data format descriptor.

struct DfdSample {
    std::uint32_t bit, bits, channel;
    std::uint32_t lower, upper;
};

namespace dfd {
constexpr std::uint32_t model_rgbsda = 1, model_bc1 = 128, model_bc3 = 130, model_bc4 = 131,
                        model_bc5 = 132, model_bc6h = 133, model_bc7 = 134;
constexpr std::uint32_t is_linear = 0x10, is_signed = 0x40, is_float = 0x80;
constexpr std::uint32_t alpha = 15, bc1_with_alpha = 1;
constexpr std::uint32_t minus_one = 0xBF800000, plus_one = 0x3F800000;  // As float.
}  // namespace dfd

std::uint32_t color_model(TextureFormat format) {
    const std::optional<BlockFormat> blocks = block_format_of(format);
    if (!blocks) return dfd::model_rgbsda;
    switch (*blocks) {
        case BlockFormat::bc7:
            return dfd::model_bc7;
        case BlockFormat::bc1:
        case BlockFormat::bc1a:
            return dfd::model_bc1;
        case BlockFormat::bc3:
            return dfd::model_bc3;
        case BlockFormat::bc6h:
        case BlockFormat::bc6h_sfloat:
            return dfd::model_bc6h;
        default:
            return channels_of(*blocks) == 1 ? dfd::model_bc4 : dfd::model_bc5;
    }
}

std::vector<DfdSample> dfd_samples(const GpuTexture& texture) {
    std::vector<DfdSample> samples;
    const std::optional<BlockFormat> blocks = block_format_of(texture.format);
    if (blocks == BlockFormat::bc7) return {{0, 128, 0, 0, 0xFFFFFFFF}};
    if (blocks == BlockFormat::bc6h) return {{0, 128, dfd::is_float, 0, dfd::plus_one}};
    if (blocks == BlockFormat::bc6h_sfloat) {
        return {{0, 128, dfd::is_float | dfd::is_signed, dfd::minus_one, dfd::plus_one}};
    }
    if (blocks == BlockFormat::bc1) return {{0, 64, 0, 0, 0xFFFFFFFF}};
    if (blocks == BlockFormat::bc1a) return {{0, 64, dfd::bc1_with_alpha, 0, 0xFFFFFFFF}};
    if (blocks == BlockFormat::bc3) {
        return {{0, 64, dfd::alpha | (texture.is_srgb ? dfd::is_linear : 0), 0, 0xFFFFFFFF},
                {64, 64, 0, 0, 0xFFFFFFFF}};
    }
    const auto channels = static_cast<std::uint32_t>(channels_of(texture.format));
    if (blocks) {
        const bool has_sign = is_signed(*blocks);
        for (std::uint32_t c = 0; c < channels; ++c) {
            samples.push_back({64 * c, 64, c | (has_sign ? dfd::is_signed : 0),
                               has_sign ? 0x80000000U : 0U, has_sign ? 0x7FFFFFFFU : 0xFFFFFFFFU});
        }
        return samples;
    }
    const auto bits =
        static_cast<std::uint32_t>(8 * texture_level_size(texture.format, 1, 1) / channels);
    const bool is_float = bits_of(texture.format) == 32;
    for (std::uint32_t c = 0; c < channels; ++c) {
        std::uint32_t channel = c == 3 ? dfd::alpha : c;
        if (c == 3 && texture.is_srgb) channel |= dfd::is_linear;
        if (is_float) {
            samples.push_back({bits * c, bits, channel | dfd::is_float | dfd::is_signed,
                               dfd::minus_one, dfd::plus_one});
        } else {
            samples.push_back({bits * c, bits, channel, 0, (1U << bits) - 1});
        }
    }
    return samples;
}

std::vector<std::byte> dfd_of(const GpuTexture& texture) {
    const std::vector<DfdSample> samples = dfd_samples(texture);
    const bool has_blocks = block_format_of(texture.format).has_value();
    const auto block_bytes = static_cast<std::uint32_t>(texture_level_size(texture.format, 1, 1));
    const auto size = static_cast<std::uint32_t>(24 + 16 * samples.size());
    std::vector<std::byte> bytes;
    const auto put = [&](std::uint32_t value) { append_little(bytes, value); };
    put(size + 4);
    put(0);                 // The basic descriptor of Khronos.
    put(2U | size << 16U);  // Version 1.3.
    constexpr std::uint32_t primaries_bt709 = 1, transfer_linear = 1, transfer_srgb = 2;
    put(color_model(texture.format) | primaries_bt709 << 8U |
        (texture.is_srgb ? transfer_srgb : transfer_linear) << 16U);
    put(has_blocks ? 3U | 3U << 8U : 0U);  // The size of a block in texels, less 1.
    put(block_bytes);
    put(0);
    for (const DfdSample& sample : samples) {
        put(sample.bit | (sample.bits - 1) << 16U | sample.channel << 24U);
        put(0);  // The position of the sample in the texel.
        put(sample.lower);
        put(sample.upper);
    }
    return bytes;
}

/// Checks that the descriptor of a file describes the texels that the Vulkan format names. Ranges
/// of values, positions of samples, primaries and sizes of planes are free.
void check_descriptor(Bytes file, const GpuTexture& texture, const std::filesystem::path& name) {
    constexpr std::size_t head_bytes = 28, sample_bytes = 16;
    const auto begin = little<std::uint32_t>(file, 48);
    const auto length = little<std::uint32_t>(file, 52);
    if (!is_in_file(begin, length, file.size()) || length < head_bytes)
        throw FileError(name, "has no format descriptor");
    const std::vector<std::byte> expected = dfd_of(texture);
    const Bytes found = file.subspan(begin, length);
    const auto differs = [&](std::size_t offset, std::uint32_t mask) {
        return ((little<std::uint32_t>(found, offset) ^ little<std::uint32_t>(expected, offset)) &
                mask) != 0;
    };
    const auto refuse = [&](const char* what) {
        throw FileError(name, fmt::format("its format descriptor contradicts {} by {}",
                                          vulkan_name(vulkan_number(texture)), what));
    };
    if (differs(4, 0xFFFFFFFF)) throw FileError(name, "has no format descriptor of Khronos");
    if (differs(12, 0xFF)) refuse("another color model");
    // A format without a variant in sRGB may have any transfer function but that of sRGB.
    constexpr std::uint32_t srgb = 2;
    const bool is_srgb = (little<std::uint32_t>(found, 12) >> 16U & 0xFFU) == srgb;
    if (is_srgb != texture.is_srgb) refuse("another transfer function");
    if (differs(16, 0xFFFFFFFF)) refuse("blocks of another size");
    if (length < expected.size() || little<std::uint32_t>(found, 8) >> 16U != expected.size() - 4)
        refuse("another number of channels");
    for (std::size_t at = head_bytes; at < expected.size(); at += sample_bytes) {
        if (differs(at, 0xFFFFFFFF)) refuse("other channels");
    }
}

// Writing.

std::vector<std::byte> entries_of(const GpuTexture& texture) {
    std::map<std::string, std::string> entries = texture.metadata;
    std::erase_if(entries, [](const auto& entry) { return entry.first.starts_with("KTX"); });
    entries["KTXorientation"] = "rd";
    entries["KTXwriter"] = "relief " RELIEF_VERSION;
    if (!texture.swizzle.empty()) entries["KTXswizzle"] = texture.swizzle;
    std::vector<std::byte> bytes;
    for (const auto& [key, value] : entries) {
        if (key.empty() || (key + value).find('\0') != std::string::npos)
            throw InvalidInput(fmt::format("the text entry '{}' is empty or contains a zero", key));
        append_little(bytes, static_cast<std::uint32_t>(key.size() + value.size() + 2));
        for (const std::string& text : {key, value}) {
            const Bytes stored = std::as_bytes(std::span(text.c_str(), text.size() + 1));
            bytes.insert(bytes.end(), stored.begin(), stored.end());
        }
        bytes.resize((bytes.size() + 3) / 4 * 4);
    }
    return bytes;
}

std::vector<std::byte> zstd_bytes(Bytes level, int quality) {
    struct Free {
        void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    };
    const std::unique_ptr<ZSTD_CCtx, Free> context(ZSTD_createCCtx());
    if (!context) throw std::bad_alloc();
    const auto check = [](std::size_t result) {
        if (ZSTD_isError(result) != 0) throw std::bad_alloc();
    };
    check(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, quality));
    check(ZSTD_CCtx_setPledgedSrcSize(context.get(), level.size()));
    std::vector<std::byte> bytes(ZSTD_compressBound(level.size()));
    ZSTD_outBuffer out{bytes.data(), bytes.size(), 0};
    // Parts let a cancellation end the slow levels.
    constexpr std::size_t part = 1 << 17;
    for (std::size_t begin = 0; begin < level.size(); begin += part) {
        check_cancelled();
        const std::size_t end = std::min(begin + part, level.size());
        ZSTD_inBuffer in{level.data() + begin, end - begin, 0};
        const bool is_last = end == level.size();
        check(
            ZSTD_compressStream2(context.get(), &out, &in, is_last ? ZSTD_e_end : ZSTD_e_continue));
    }
    bytes.resize(out.pos);
    return bytes;
}

void check_swizzle(const std::string& swizzle) {
    const bool is_valid =
        swizzle.empty() ||
        (swizzle.size() == 4 && swizzle.find_first_not_of("rgba01") == std::string::npos);
    if (!is_valid)
        throw InvalidInput(fmt::format("a swizzle has four letters of rgba01, not '{}'", swizzle));
}

}  // namespace

TextureContainer open_ktx2(Bytes bytes, const std::filesystem::path& name) {
    if (!text_of(bytes).starts_with(ktx2_identifier)) throw FileError(name, "is not a KTX2 file");
    if (bytes.size() < ktx2_header_bytes) throw FileError(name, "is cut short within its header");
    const auto number = [&](std::size_t offset) { return little<std::uint32_t>(bytes, offset); };
    const std::uint32_t scheme = number(44);
    if (scheme == 1) throw FileError(name, "has the Vulkan format 0 (BasisLZ), which is not read");
    const VulkanFormat& format = read_vulkan_format(number(12), name);
    const std::uint32_t width = number(20);
    const std::uint32_t height = number(24);
    if (number(36) == 6) throw FileError(name, "is a cube map, but only single images are read");
    if (height == 0 || number(28) > 0 || number(36) != 1)
        throw FileError(name, "is not a two-dimensional texture");
    if (number(32) > 1) {
        throw FileError(name, fmt::format("is an array of {} textures, but only single images are "
                                          "read",
                                          number(32)));
    }
    constexpr std::uint32_t max_side = std::uint32_t{1} << 30;
    if (width < 1 || width > max_side || height > max_side)
        throw FileError(name, fmt::format("announces {} x {} texels", width, height));
    if (scheme != 0 && scheme != 2) {
        throw FileError(
            name, fmt::format("has the supercompression {}, but only zstd (2) is read", scheme));
    }
    TextureContainer container;
    container.is_zstd = scheme == 2;
    container.header.format = format.format;
    container.header.is_srgb = format.is_srgb;
    container.header.width = static_cast<int>(width);
    container.header.height = static_cast<int>(height);
    require_image_fits(image_info_of(container.header), name);
    if (container.is_zstd) require_in_proportion(container.header, bytes.size(), name);
    check_descriptor(bytes, container.header, name);
    const std::uint32_t levels = std::max(number(40), 1U);
    if (levels > 31 || std::max(width, height) >> (levels - 1) == 0) {
        throw FileError(
            name, fmt::format("announces {} mip levels of {} x {} texels", levels, width, height));
    }
    if (bytes.size() - ktx2_header_bytes < levels * level_entry_bytes)
        throw FileError(name, "is cut short within its index of levels");
    for (std::size_t level = 0; level < levels; ++level) {
        const std::size_t entry = ktx2_header_bytes + level * level_entry_bytes;
        const StoredLevel stored{little<std::uint64_t>(bytes, entry),
                                 little<std::uint64_t>(bytes, entry + 8)};
        const std::size_t size =
            texture_level_size(format.format, level_side(container.header.width, level),
                               level_side(container.header.height, level));
        if (!is_in_file(stored.offset, stored.size, bytes.size())) {
            throw FileError(name,
                            fmt::format("level {} has {} bytes from byte {}, but the file has "
                                        "only {}",
                                        level, stored.size, stored.offset, bytes.size()));
        }
        const auto announced = little<std::uint64_t>(bytes, entry + 16);
        const bool is_wrong = container.is_zstd ? announced != size : stored.size != size;
        if (is_wrong) {
            throw FileError(name,
                            fmt::format("level {} has {} bytes, but its texels need {}", level,
                                        container.is_zstd ? announced : stored.size, size));
        }
        if (container.is_zstd) check_compressed_size(stored.size, size, level, name);
        container.levels.push_back(stored);
    }
    const std::uint32_t entries = number(56);
    const std::uint32_t entries_size = number(60);
    if (!is_in_file(entries, entries_size, bytes.size()))
        throw FileError(name, "has text entries beyond its end");
    read_entries(bytes.subspan(entries, entries_size), name, container.header);
    return container;
}

std::vector<std::byte> load_level(const TextureContainer& container, Bytes bytes, std::size_t level,
                                  const std::filesystem::path& name) {
    const StoredLevel& stored = container.levels[level];
    const Bytes data = bytes.subspan(stored.offset, stored.size);
    if (!container.is_zstd) return {data.begin(), data.end()};
    const std::size_t size =
        texture_level_size(container.header.format, level_side(container.header.width, level),
                           level_side(container.header.height, level));
    require_memory_for(name, size);
    std::vector<std::byte> result(size);
    const std::size_t got = ZSTD_decompress(result.data(), result.size(), data.data(), data.size());
    if (ZSTD_isError(got) != 0) {
        throw FileError(name, fmt::format("level {} cannot be decompressed: {}", level,
                                          ZSTD_getErrorName(got)));
    }
    if (got != size) {
        throw FileError(
            name, fmt::format("level {} has {} bytes, but its texels need {}", level, got, size));
    }
    return result;
}

std::vector<std::byte> ktx2_bytes(const GpuTexture& texture, const TextureWriteOptions& options) {
    std::vector<std::byte> bytes;
    write_ktx2(texture, options,
               [&](Bytes part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    return bytes;
}

void write_ktx2(const GpuTexture& texture, const TextureWriteOptions& options,
                const std::function<void(Bytes)>& write) {
    check_swizzle(texture.swizzle);
    if (options.zstd_level && (*options.zstd_level < 1 || *options.zstd_level > 22))
        throw InvalidInput(fmt::format("zstd has levels 1 to 22, not {}", *options.zstd_level));
    const std::vector<std::byte> descriptor = dfd_of(texture);
    const std::vector<std::byte> entries = entries_of(texture);
    std::vector<std::vector<std::byte>> compressed_levels;
    if (options.zstd_level) {
        for (const std::vector<std::byte>& level : texture.levels)
            compressed_levels.push_back(zstd_bytes(level, *options.zstd_level));
    }
    const auto& levels = options.zstd_level ? compressed_levels : texture.levels;
    const std::size_t index_end = ktx2_header_bytes + levels.size() * level_entry_bytes;
    const std::size_t entries_begin = index_end + descriptor.size();
    // Levels that are not compressed begin at multiples of the size of a texel or block, and of 4.
    std::size_t alignment = 1;
    if (!options.zstd_level)
        alignment = std::max<std::size_t>(texture_level_size(texture.format, 1, 1), 4);
    std::vector<std::size_t> offsets(levels.size());
    std::size_t end = entries_begin + entries.size();
    for (std::size_t i = levels.size(); i-- > 0;) {
        offsets[i] = (end + alignment - 1) / alignment * alignment;
        end = offsets[i] + levels[i].size();
    }
    const Bytes identifier = std::as_bytes(std::span(ktx2_identifier));
    std::vector<std::byte> bytes(identifier.begin(), identifier.end());
    const auto put = [&](std::size_t value) {
        append_little(bytes, static_cast<std::uint32_t>(value));
    };
    put(vulkan_number(texture));
    put(type_size(texture.format));
    put(static_cast<std::size_t>(texture.width));
    put(static_cast<std::size_t>(texture.height));
    put(0);  // Depth.
    put(0);  // No array.
    put(1);  // One face.
    put(levels.size());
    put(options.zstd_level ? 2 : 0);
    put(index_end);
    put(descriptor.size());
    put(entries_begin);
    put(entries.size());
    append_little(bytes, std::uint64_t{0});  // No global data of the compression.
    append_little(bytes, std::uint64_t{0});
    for (std::size_t i = 0; i < levels.size(); ++i) {
        append_little(bytes, static_cast<std::uint64_t>(offsets[i]));
        append_little(bytes, static_cast<std::uint64_t>(levels[i].size()));
        append_little(bytes, static_cast<std::uint64_t>(texture.levels[i].size()));
    }
    bytes.insert(bytes.end(), descriptor.begin(), descriptor.end());
    bytes.insert(bytes.end(), entries.begin(), entries.end());
    std::size_t written = 0;
    for (std::size_t i = levels.size(); i-- > 0;) {
        bytes.resize(offsets[i] - written);  // Zeros up to the level.
        write(bytes);
        write(levels[i]);
        bytes.clear();
        written = offsets[i] + levels[i].size();
    }
}

}  // namespace relief::detail
