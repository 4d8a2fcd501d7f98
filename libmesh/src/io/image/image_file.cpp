// SPDX-License-Identifier: Apache-2.0
// Reads whole image files and PNG's color tags. TIFF, EXR and large PNG files are read by rows, all
// others from memory: bytes -> container checks -> decoder -> Image. Common PNG and JPEG files and
// textures (texture_container.h) have a direct decoder; all others go to the image module. Damaged,
// truncated, empty and oversized files are FileErrors.
//
// JPEG is decoded with libjpeg-turbo, which OpenImageIO uses too, to the same samples. No other
// file uses libjpeg-turbo.
#include "relief/mesh/image_file.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <fstream>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "files.h"
#include "io/image/image_file_container.h"
#include "io/image/image_module_client.h"
#include "io/image/row_codec.h"
#include "io/image/texture_container.h"
#include "io/png/png_format.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// The header of a JPEG.
struct PlainJpeg {
    int width = 0;
    int height = 0;
    int channels = 0;  ///< 1 for gray, 3 for RGB.
};

struct Destroy {
    void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Destroy>;

Decoder make_decoder() {
    Decoder decoder(tjInitDecompress());
    if (!decoder) throw std::bad_alloc();
    return decoder;
}

const unsigned char* data_of(std::span<const std::byte> bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

/// Returns nullopt if the JPEG is not plain: gray or color, 8 bits, not CMYK.
/// \param stripped  the file without Exif and the like (image_file_container.h)
std::optional<PlainJpeg> open_plain_jpeg(std::span<const std::byte> stripped) {
    const Decoder decoder = make_decoder();
    PlainJpeg jpeg;
    int subsampling = 0;
    int colors = 0;
    if (tjDecompressHeader3(decoder.get(), data_of(stripped), stripped.size(), &jpeg.width,
                            &jpeg.height, &subsampling, &colors) != 0) {
        return std::nullopt;
    }
    if (colors != TJCS_GRAY && colors != TJCS_RGB && colors != TJCS_YCbCr) return std::nullopt;
    jpeg.channels = colors == TJCS_GRAY ? 1 : 3;
    const std::size_t max_rows = max_image_samples / static_cast<std::size_t>(jpeg.channels) /
                                 static_cast<std::size_t>(jpeg.width);
    if (static_cast<std::size_t>(jpeg.height) > max_rows) return std::nullopt;
    return jpeg;
}

/// Returns the samples; nullopt if the decoder reports any problem.
std::optional<std::vector<std::uint8_t>> decode(const PlainJpeg& jpeg,
                                                std::span<const std::byte> stripped) {
    const Decoder decoder = make_decoder();
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(jpeg.width) *
                                      static_cast<std::size_t>(jpeg.height) *
                                      static_cast<std::size_t>(jpeg.channels));
    const int format = jpeg.channels == 1 ? TJPF_GRAY : TJPF_RGB;
    if (tjDecompress2(decoder.get(), data_of(stripped), stripped.size(), samples.data(), jpeg.width,
                      0, jpeg.height, format, TJFLAG_STOPONWARNING) != 0) {
        return std::nullopt;
    }
    return samples;
}

/// The decoding of a file, which a thread may finish after its result is not needed any more.
struct Decoding {
    PlainJpeg jpeg;
    std::vector<std::byte> file;
    std::mutex mutex;
    std::condition_variable finished;
    bool is_finished = false;
    std::optional<std::vector<std::uint8_t>> samples;
    std::exception_ptr error;
};

/// Decodes on a thread of its own, because libjpeg-turbo decodes a file in one call, which nothing
/// ends: 8192 x 8192 texels take 1.5 s. \throws Cancelled if cancellation was requested
std::optional<std::vector<std::uint8_t>> decode_cancellably(const PlainJpeg& jpeg,
                                                            std::span<const std::byte> stripped) {
    constexpr std::chrono::milliseconds interval(20);
    const auto work = std::make_shared<Decoding>();
    work->jpeg = jpeg;
    work->file.assign(stripped.begin(), stripped.end());
    std::thread([work] {
        std::optional<std::vector<std::uint8_t>> samples;
        std::exception_ptr error;
        try {
            samples = decode(work->jpeg, work->file);
        } catch (...) {
            error = std::current_exception();
        }
        const std::lock_guard lock(work->mutex);
        work->samples = std::move(samples);
        work->error = error;
        work->is_finished = true;
        work->finished.notify_all();
    }).detach();
    std::unique_lock lock(work->mutex);
    while (!work->is_finished) {
        work->finished.wait_for(lock, interval);
        check_cancelled();
    }
    if (work->error) std::rethrow_exception(work->error);
    return std::move(work->samples);
}

std::optional<std::vector<std::uint8_t>> decode_jpeg(const PlainJpeg& jpeg,
                                                     std::span<const std::byte> stripped) {
    constexpr std::size_t quick_samples = std::size_t{1} << 23;
    const std::size_t samples = static_cast<std::size_t>(jpeg.width) *
                                static_cast<std::size_t>(jpeg.height) *
                                static_cast<std::size_t>(jpeg.channels);
    return current_progress == nullptr || samples <= quick_samples
               ? decode(jpeg, stripped)
               : decode_cancellably(jpeg, stripped);
}

/// \param samples  the decoder's result
template <typename Header, typename Samples>
std::optional<Image> image_of(const Header& header, std::optional<Samples> samples) {
    if (!samples) return std::nullopt;
    return Image{header.width, header.height, header.channels, ColorSpace::data,
                 std::move(*samples)};
}

}  // namespace

std::optional<Image> detail::read_directly(const ImageContainer& container,
                                           const std::filesystem::path& name) {
    const std::string_view format = container.format;
    if (format == "png") {
        if (const auto png = open_plain_png(container.stripped)) {
            require_image_fits({png->width, png->height, png->channels, png->bits(), {}}, name);
            return image_of(*png, decode(*png));
        }
    } else if (format == "jpeg") {
        if (const auto jpeg = open_plain_jpeg(container.stripped)) {
            require_image_fits({jpeg->width, jpeg->height, jpeg->channels, 8, {}}, name);
            return image_of(*jpeg, decode_jpeg(*jpeg, container.stripped));
        }
    }
    return std::nullopt;
}

namespace {

/// Returns the header and text of common files; nullopt for other kinds.
std::optional<ImageInfo> read_info_directly(const ImageContainer& container) {
    const std::string_view format = container.format;
    if (format == "png") {
        if (const auto png = open_plain_png(container.stripped))
            return ImageInfo{png->width, png->height, png->channels, png->bits(), container.text};
    } else if (format == "jpeg") {
        if (const auto jpeg = open_plain_jpeg(container.stripped))
            return ImageInfo{jpeg->width, jpeg->height, jpeg->channels, 8, {}};
    }
    return std::nullopt;
}

ColorSpace color_space_of(ImageUse use, int bits) {
    if (use == ImageUse::data) return ColorSpace::data;
    return bits == 32 ? ColorSpace::linear : ColorSpace::srgb;
}

/// Reads a whole file. Files that are too large for any image are refused before memory is
/// allocated.
std::string read_bytes(const std::filesystem::path& file) {
    constexpr std::uintmax_t largest = max_image_samples * sizeof(float);
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    if (!unknown && size > largest) {
        throw FileError(
            file, fmt::format("has {} bytes; relief reads images of up to {}", size, largest));
    }
    return read_file(file);
}

/// Opens KTX2 files, and DDS files whose format is one of TextureFormat.
std::optional<TextureContainer> open_texture(const ImageContainer& container,
                                             std::span<const std::byte> bytes,
                                             const std::filesystem::path& name) {
    const std::string_view format = container.format;
    if (format == "ktx2") return open_ktx2(bytes, name);
    if (format == "dds") return open_dds(bytes, name);
    return std::nullopt;
}

Image read_encoded(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    const ImageContainer container = examine_image(bytes, name);
    if (const auto texture = open_texture(container, bytes, name))
        return read_largest_level(*texture, bytes, name);
    if (std::optional<Image> image = read_directly(container, name)) return std::move(*image);
    return read_all(*module_rows(container, bytes, name), name);
}

ImageInfo info_of(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    const ImageContainer container = examine_image(bytes, name);
    if (const auto texture = open_texture(container, bytes, name))
        return image_info_of(texture->header);
    if (std::optional<ImageInfo> info = read_info_directly(container)) return std::move(*info);
    return module_rows(container, bytes, name)->info();
}

/// Below this size, reading and inflating a PNG at once is faster.
constexpr std::uintmax_t large_png = std::uintmax_t{1} << 20;

Image read_from_file(const std::filesystem::path& file) {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    const bool is_small_png = !unknown && size < large_png && lower_extension(file) == ".png";
    if (!is_small_png) {
        if (const auto rows = open_streamed_rows(file)) return read_all(*rows, file);
    }
    const std::string contents = read_bytes(file);
    return read_encoded(std::as_bytes(std::span(contents)), file);
}

/// Sets the color space of the result of `read` by its use.
template <typename Read>
Image read_for(ImageUse use, const std::filesystem::path& name, Read read) {
    try {
        Image image = read();
        image.color_space = color_space_of(use, image.bits());
        return image;
    } catch (const std::bad_alloc&) {
        throw FileError(name, "does not fit into memory");
    }
}

}  // namespace

Image read_image(const std::filesystem::path& file, ImageUse use) {
    return read_for(use, file, [&] { return read_from_file(file); });
}

Image read_image(std::span<const std::byte> bytes, const std::string& name, ImageUse use) {
    return read_for(use, name, [&] { return read_encoded(bytes, name); });
}

ImageInfo read_image_info(const std::filesystem::path& file) {
    if (const auto rows = open_streamed_rows(file)) return rows->info();
    const std::string contents = read_bytes(file);
    return info_of(std::as_bytes(std::span(contents)), file);
}

ImageInfo read_image_info(std::span<const std::byte> bytes, const std::string& name) {
    return info_of(bytes, name);
}

namespace {

constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

/// Returns the color tag in a chunk; empty for most chunks.
std::string tag_of(std::string_view type, std::istream& file) {
    if (type == "sRGB") return "sRGB";
    if (type == "iCCP") return "ICC profile";
    if (type == "cICP") return "coding-independent code points";
    if (type != "gAMA") return "";
    std::array<char, 4> stored{};
    if (!file.read(stored.data(), stored.size())) return "";
    const std::uint32_t gamma = big32(std::as_bytes(std::span(stored)));
    return gamma == 100000 ? "" : fmt::format("gamma {:g}", gamma / 100000.0);
}

}  // namespace

std::string color_tag(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw FileError(file, "cannot be opened");
    std::array<char, 8> head{};
    if (!stream.read(head.data(), head.size()) ||
        std::string_view(head.data(), head.size()) != png_signature)
        return "";
    std::streamoff next = 8;
    while (stream.seekg(next) && stream.read(head.data(), head.size())) {
        const std::string_view type(head.data() + 4, 4);
        if (type == "IDAT" || type == "IEND") return "";
        const std::string tag = tag_of(type, stream);
        if (!tag.empty()) return tag;
        next += 12 + static_cast<std::streamoff>(big32(std::as_bytes(std::span(head))));
    }
    return "";
}

}  // namespace relief
