// SPDX-License-Identifier: Apache-2.0
// The image module: OpenImageIO behind the table of image_module.h. The only file that knows it.
// Reads encoded bytes as 8-bit, 16-bit or float samples exactly as stored: no colour conversion, no
// multiplied alpha; first subimage, first mip level, data window. What goes wrong comes back as
// text, never as an exception: everything thrown inside ends here.
// Tests: tests/mesh/io/image/image_file_test.cpp.
#include "io/image/image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "io/image/image_module_png.h"

namespace relief {

struct ImageModuleReader {
    std::unique_ptr<OIIO::Filesystem::IOProxy> bytes;
    std::unique_ptr<OIIO::ImageInput> input;
    ImageModuleHeader header;
};

struct ImageModuleWriter {
    std::unique_ptr<OIIO::ImageOutput> output;
    ImageModuleHeader header;
};

namespace {

void fail(const ImageModuleFailure& failure, const std::string& text) {
    failure.fail(failure.receiver, text.empty() ? "no reason is known" : text.c_str());
}

/// Runs `body`, and turns whatever it throws into text. The result is `otherwise` then.
template <typename Result, typename Body>
Result guarded(const ImageModuleFailure& failure, Result otherwise, Body body) {
    try {
        return body();
    } catch (const std::exception& error) {
        fail(failure, error.what());
    } catch (...) {
        fail(failure, "an unknown kind of exception");
    }
    return otherwise;
}

/// The pending message of a reader or writer, or else the library's own; what libpng says is more
/// than OpenImageIO makes of it.
template <typename File>
std::string pending_error(File& file) {
    const std::string text = file.has_error() ? file.geterror() : OIIO::geterror();
    const std::string complaint = last_png_complaint();
    return complaint.empty() ? text : "PNG: " + complaint;
}

OIIO::TypeDesc sample_type(int bits) {
    if (bits == 8) return OIIO::TypeDesc::UINT8;
    if (bits == 16) return OIIO::TypeDesc::UINT16;
    return OIIO::TypeDesc::FLOAT;
}

/// 8 and 16 where every channel is an unsigned integer of that size, else 32.
int bits_of(const OIIO::ImageSpec& spec) {
    int bits = 8;
    for (int channel = 0; channel < spec.nchannels; ++channel) {
        const OIIO::TypeDesc type = spec.channelformat(channel);
        bits = std::max(bits, type == OIIO::TypeDesc::UINT8    ? 8
                              : type == OIIO::TypeDesc::UINT16 ? 16
                                                               : 32);
    }
    return bits;
}

void hand_out_text(const OIIO::ImageSpec& spec, const ImageModuleText& text) {
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        if (attribute.type() != OIIO::TypeDesc::STRING) continue;
        const std::string key = attribute.name().string();
        if (key.rfind("oiio:", 0) == 0) continue;
        text.entry(text.receiver, key.c_str(), attribute.get_string().c_str());
    }
}

/// Opens what `bytes` gives.
ImageModuleReader* open_proxy(const char* format, std::unique_ptr<OIIO::Filesystem::IOProxy> bytes,
                              ImageModuleHeader* header, ImageModuleText text,
                              ImageModuleFailure failure) {
    auto reader = std::make_unique<ImageModuleReader>();
    reader->bytes = std::move(bytes);
    reader->input = OIIO::ImageInput::create(format);
    if (!reader->input) return fail(failure, OIIO::geterror()), nullptr;
    // Opening with both a configuration and a proxy in one call fails in OpenImageIO 2.4; the
    // proxy set beforehand works.
    if (!reader->input->set_ioproxy(reader->bytes.get()))
        return fail(failure, "this format cannot be read from memory"), nullptr;
    OIIO::ImageSpec wish;
    wish["oiio:UnassociatedAlpha"] = 1;
    OIIO::ImageSpec spec;
    if (!reader->input->open(std::string("image.") + format, spec, wish))
        return fail(failure, pending_error(*reader->input)), nullptr;
    if (spec.deep || spec.depth > 1)
        return fail(failure, "holds a volume or deep samples"), nullptr;
    reader->header = {spec.width, spec.height, spec.nchannels, bits_of(spec)};
    *header = reader->header;
    hand_out_text(spec, text);
    return reader.release();
}

ImageModuleReader* open(const char* format, const void* bytes, std::size_t size,
                        ImageModuleHeader* header, ImageModuleText text,
                        ImageModuleFailure failure) {
    return guarded<ImageModuleReader*>(failure, nullptr, [&] {
        return open_proxy(format, std::make_unique<OIIO::Filesystem::IOMemReader>(bytes, size),
                          header, text, failure);
    });
}

ImageModuleReader* open_file(const char* format, const char* path, ImageModuleHeader* header,
                             ImageModuleText text, ImageModuleFailure failure) {
    return guarded<ImageModuleReader*>(failure, nullptr, [&]() -> ImageModuleReader* {
        auto file =
            std::make_unique<OIIO::Filesystem::IOFile>(path, OIIO::Filesystem::IOProxy::Read);
        if (!file->opened()) return fail(failure, file->error()), nullptr;
        return open_proxy(format, std::move(file), header, text, failure);
    });
}

std::int64_t row_grain(ImageModuleReader* reader) {
    const int tile_height = reader->input->spec().tile_height;
    return std::max(1, tile_height);
}

bool read(ImageModuleReader* reader, std::int64_t first, std::int64_t end, void* samples,
          ImageModuleFailure failure) {
    return guarded(failure, false, [&] {
        OIIO::ImageInput& input = *reader->input;
        const OIIO::ImageSpec spec = input.spec_dimensions(0, 0);
        const OIIO::TypeDesc type = sample_type(reader->header.bits);
        const int top = spec.y + static_cast<int>(first);
        const int bottom = spec.y + static_cast<int>(end);
        const bool read =
            spec.tile_width > 0
                ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, top, bottom, spec.z,
                                   spec.z + 1, 0, spec.nchannels, type, samples)
                : input.read_scanlines(0, 0, top, bottom, spec.z, 0, spec.nchannels, type, samples);
        // Truncated files may read with success and leave an error pending.
        if (read && !input.has_error()) return true;
        fail(failure, pending_error(input));
        return false;
    });
}

void close(ImageModuleReader* reader) {
    try {
        delete reader;
    } catch (...) {
        // Nothing is written by a reader: what fails in its end has no consequence.
        return;
    }
}

/// What every format of ours is written with.
OIIO::ImageSpec spec_to_write(const std::string& format, const ImageModulePicture& picture) {
    const ImageModuleHeader& header = picture.header;
    OIIO::ImageSpec spec(
        static_cast<int>(header.width), static_cast<int>(header.height),
        static_cast<int>(header.channels),
        picture.half ? OIIO::TypeDesc(OIIO::TypeDesc::HALF) : sample_type(header.bits));
    spec.channelnames = header.channels < 3 ? std::vector<std::string>{"Y", "A"}
                                            : std::vector<std::string>{"R", "G", "B", "A"};
    spec.channelnames.resize(static_cast<std::size_t>(header.channels));
    if (picture.channel_names != nullptr)
        spec.channelnames.assign(picture.channel_names, picture.channel_names + header.channels);
    const bool is_color = picture.channel_names == nullptr;
    spec.alpha_channel =
        is_color && header.channels % 2 == 0 ? static_cast<int>(header.channels) - 1 : -1;
    spec["oiio:UnassociatedAlpha"] = 1;
    if (picture.srgb) spec["oiio:ColorSpace"] = "sRGB";
    if (format == "tiff" || format == "openexr") spec["compression"] = "zip";
    if (format == "tiff") spec["tiff:zipquality"] = picture.zip_quality;
    // Plain TIFF has 32-bit offsets; what deflate makes of the samples is not known yet.
    constexpr std::uint64_t large = 0xF0000000;
    if (format == "tiff" && spec.image_bytes(true) >= large) spec["tiff:bigtiff"] = 1;
    // OpenImageIO 2.4 takes some of its own entries for Exif and then cannot write them.
    if (format == "tiff") spec["tiff:write_exif"] = 0;
    // Else the date would be written, and the same image would never give the same file.
    if (format == "tiff" || format == "openexr") spec["DateTime"] = "";
    if (format == "jpeg") {
        spec["compression"] = "jpeg:95";
        spec["jpeg:subsampling"] = "4:4:4";  // Data maps must not bleed between channels' rows.
    }
    for (std::size_t entry = 0; entry < picture.text_count; ++entry)
        spec.attribute(picture.keys[entry], std::string(picture.values[entry]));
    return spec;
}

ImageModuleWriter* create(const char* format, const char* path, const ImageModulePicture* picture,
                          ImageModuleFailure failure) {
    return guarded<ImageModuleWriter*>(failure, nullptr, [&]() -> ImageModuleWriter* {
        auto writer = std::make_unique<ImageModuleWriter>();
        writer->header = picture->header;
        writer->output = OIIO::ImageOutput::create(format);
        if (!writer->output) return fail(failure, OIIO::geterror()), nullptr;
        if (writer->output->open(path, spec_to_write(format, *picture))) return writer.release();
        fail(failure, pending_error(*writer->output));
        return nullptr;
    });
}

bool write(ImageModuleWriter* writer, std::int64_t first, std::int64_t end, const void* samples,
           ImageModuleFailure failure) {
    return guarded(failure, false, [&] {
        OIIO::ImageOutput& output = *writer->output;
        const bool written = output.write_scanlines(static_cast<int>(first), static_cast<int>(end),
                                                    0, sample_type(writer->header.bits), samples);
        if (written && !output.has_error()) return true;
        fail(failure, pending_error(output));
        return false;
    });
}

bool finish(ImageModuleWriter* writer, ImageModuleFailure failure) {
    return guarded(failure, false, [&] {
        OIIO::ImageOutput& output = *writer->output;
        if (output.close() && !output.has_error()) return true;
        fail(failure, pending_error(output));
        return false;
    });
}

void release(ImageModuleWriter* writer) {
    try {
        delete writer;
    } catch (...) {
        // The file is complete, or nobody's.
        return;
    }
}

constexpr ImageModule table{
    image_module_version, open, open_file, row_grain, read, close, create, write, finish, release};

}  // namespace
}  // namespace relief

extern "C" __attribute__((visibility("default"))) const relief::ImageModule* relief_image_module() {
    return &relief::table;
}
