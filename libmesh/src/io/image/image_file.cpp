// SPDX-License-Identifier: Apache-2.0
// Reading whole image files: bytes -> container checks -> a decoder -> Image. The usual PNG
// and JPEG files have a direct way; all else goes through the image module.
// Samples arrive as stored and from the top row; memory is taken as rows decode, so that a header
// that lies costs nothing. Damaged, truncated, empty or oversized files are a FileError.
// Tests: tests/mesh/io/image/image_file_test.cpp.
#include "relief/mesh/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "file_bytes.h"
#include "io/image/image_file_container.h"
#include "io/image/image_file_direct.h"
#include "io/image/image_file_module.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

using Metadata = std::map<std::string, std::string>;

constexpr std::size_t bytes_per_step = std::size_t{1} << 24;

// ---------------------------------------------------------------------------------------------
// Across the module's border

ImageModuleFailure into(std::string& reason) {
    return {&reason, [](void* receiver, const char* text) {
                // The first line says it; decoders like to add more.
                const std::string_view all(text);
                static_cast<std::string*>(receiver)->assign(all.substr(0, all.find('\n')));
            }};
}

/// Text that the file itself holds. Of what OpenImageIO adds, these are facts of the coding; the
/// text of PNG is read by ourselves, and other formats have none worth keeping.
ImageModuleText into(Metadata& metadata) {
    return {&metadata, [](void* receiver, const char* key, const char* value) {
                for (const std::string_view coding : {"compression", "textureformat", "wrapmodes",
                                                      "ResolutionUnit", "planarconfig"}) {
                    if (key == coding) return;
                }
                static_cast<Metadata*>(receiver)->emplace(key, value);
            }};
}

struct CloseReader {
    const ImageModule* module = nullptr;
    void operator()(ImageModuleReader* reader) const { module->close(reader); }
};

/// An encoded image, opened and found acceptable.
struct OpenImage {
    ImageContainer container;
    Metadata metadata;
    ImageModuleHeader header;
    std::unique_ptr<ImageModuleReader, CloseReader> reader;  ///< Last: it reads from `container`.
};

void check_header(const ImageModuleHeader& header, const std::filesystem::path& name) {
    if (header.width < 1 || header.height < 1) {
        throw FileError(name, fmt::format("is empty: {} x {} texels", header.width, header.height));
    }
    if (header.channels < 1 || header.channels > 4)
        throw FileError(name, fmt::format("has {} channels; relief reads 1 to 4", header.channels));
    const auto width = static_cast<std::size_t>(header.width);
    const auto height = static_cast<std::size_t>(header.height);
    if (width > max_image_samples / height / static_cast<std::size_t>(header.channels)) {
        throw FileError(name, fmt::format("has {} x {} texels of {} channels; relief reads up to "
                                          "{} samples",
                                          width, height, header.channels, max_image_samples));
    }
}

/// TIFF has no place for entries of one's own: they stand in its description, one a line.
void unfold_description(Metadata& metadata) {
    const auto description = metadata.find("ImageDescription");
    if (description == metadata.end()) return;
    std::string_view rest = description->second;
    while (!rest.empty()) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        const std::size_t equals = line.find('=');
        if (line.starts_with("relief:") && equals != std::string_view::npos)
            metadata.emplace(line.substr(0, equals), line.substr(equals + 1));
    }
}

/// What a decoder is given: PNG and JPEG without what does not define their samples.
std::span<const std::byte> encoded_in(const ImageContainer& container,
                                      std::span<const std::byte> bytes) {
    return container.stripped.empty() ? bytes : std::span(container.stripped);
}

/// \param bytes  of which `container` was made
OpenImage open_image(ImageContainer container, std::span<const std::byte> bytes,
                     const std::filesystem::path& name) {
    OpenImage image;
    image.container = std::move(container);
    const ImageModule& module = image_module(name);
    const std::span<const std::byte> encoded = encoded_in(image.container, bytes);
    Metadata text;
    std::string reason;
    image.reader = {module.open(image.container.format, encoded.data(), encoded.size(),
                                &image.header, into(text), into(reason)),
                    CloseReader{&module}};
    if (image.reader == nullptr) throw FileError(name, reason);
    check_header(image.header, name);
    const std::string_view format = image.container.format;
    if (format == "png") image.metadata = image.container.text;
    if (format == "openexr" || format == "tiff") image.metadata = text;
    if (format == "tiff") unfold_description(image.metadata);
    return image;
}

// ---------------------------------------------------------------------------------------------
// Reading

template <typename Sample>
std::vector<Sample> read_samples(const OpenImage& image, const std::filesystem::path& name) {
    const ImageModuleHeader& header = image.header;
    const ImageModule& module = *image.reader.get_deleter().module;
    const auto row = static_cast<std::size_t>(header.width * header.channels);
    // Steps of whole tiles, and of a multiple of 64 rows, which compressed formats decode at once.
    const std::int64_t grain = module.row_grain(image.reader.get()) * 64;
    const std::int64_t step =
        grain * std::max<std::int64_t>(
                    1, static_cast<std::int64_t>(bytes_per_step / (row * sizeof(Sample))) / grain);
    std::vector<Sample> samples;
    samples.reserve(row * static_cast<std::size_t>(header.height));
    for (std::int64_t first = 0; first < header.height; first += step) {
        const std::int64_t end = std::min(first + step, header.height);
        samples.resize(row * static_cast<std::size_t>(end));
        std::string reason;
        if (!module.read(image.reader.get(), first, end,
                         samples.data() + row * static_cast<std::size_t>(first), into(reason))) {
            throw FileError(name, fmt::format("rows {} to {} of {} are damaged: {}", first, end - 1,
                                              header.height, reason));
        }
    }
    return samples;
}

ColorSpace color_space_of(ImageUse use, int bits) {
    if (use == ImageUse::data) return ColorSpace::data;
    return bits == 32 ? ColorSpace::linear : ColorSpace::srgb;
}

/// A whole file; refuses what no acceptable image can be, before memory is taken.
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

/// By way of the image module.
Image read_by_module(const OpenImage& open, const std::filesystem::path& name, ImageUse use) {
    Image image{static_cast<int>(open.header.width),
                static_cast<int>(open.header.height),
                static_cast<int>(open.header.channels),
                color_space_of(use, open.header.bits),
                {}};
    switch (open.header.bits) {
        case 8:
            image.samples = read_samples<std::uint8_t>(open, name);
            break;
        case 16:
            image.samples = read_samples<std::uint16_t>(open, name);
            break;
        default:
            image.samples = read_samples<float>(open, name);
            break;
    }
    return image;
}

Image read_encoded(std::span<const std::byte> bytes, const std::filesystem::path& name,
                   ImageUse use) {
    try {
        ImageContainer container = examine_image(bytes, name);
        if (std::optional<Image> image = read_directly(container)) {
            image->color_space = color_space_of(use, image->bits());
            return std::move(*image);
        }
        return read_by_module(open_image(std::move(container), bytes, name), name, use);
    } catch (const std::bad_alloc&) {
        throw FileError(name, "does not fit into memory");
    }
}

}  // namespace

Image read_image(const std::filesystem::path& file, ImageUse use) {
    const std::string contents = read_bytes(file);
    return read_encoded(std::as_bytes(std::span(contents)), file, use);
}

Image read_image(std::span<const std::byte> bytes, const std::string& name, ImageUse use) {
    return read_encoded(bytes, name, use);
}

ImageInfo read_image_info(const std::filesystem::path& file) {
    const std::string contents = read_bytes(file);
    const auto bytes = std::as_bytes(std::span(contents));
    ImageContainer container = examine_image(bytes, file);
    if (std::optional<ImageInfo> info = read_info_directly(container)) return std::move(*info);
    const OpenImage open = open_image(std::move(container), bytes, file);
    return {static_cast<int>(open.header.width), static_cast<int>(open.header.height),
            static_cast<int>(open.header.channels), open.header.bits, open.metadata};
}

}  // namespace relief
