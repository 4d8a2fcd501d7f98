// SPDX-License-Identifier: Apache-2.0
// The image module: OpenImageIO behind the table of image_module.h. This is the only file that uses
// it.
//
// Encoded bytes become 8-bit, 16-bit or float samples exactly as stored: no color conversion, no
// multiplied alpha; first subimage, first mip level, data window. Errors are returned as text; no
// exception leaves the module.
#include "io/image/image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>

namespace {

// --- Replaced functions of libpng and libtiff ---

thread_local std::string last_message;

// The types of handlers and functions as libpng 1.6 declares them, with opaque pointers.
using Handler = void (*)(void* png, const char* text);
using Create = void* (*)(const char* version, void* receiver, Handler error, Handler warning);
using SetHandlers = void (*)(void* png, void* receiver, Handler error, Handler warning);
using Jump = void (*)(void* png, int value);

template <typename Function>
Function in_libpng(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

[[noreturn]] void jump_out(void* png, const char* text) {
    last_message = text;
    if (const auto jump = in_libpng<Jump>("png_longjmp")) jump(png, 1);
    std::abort();  // An error handler must not return, and without the jump there is no
                   // alternative.
}

void ignore_message(void*, const char*) {}

/// Returns libpng's last message in this thread and clears it; empty if there is none.
std::string take_png_message() {
    return std::exchange(last_message, {});
}

}  // namespace

/// Keeps libpng from printing. OpenImageIO 2.4 leaves libpng its default handlers, which write
/// errors and warnings to stderr, but libraries of relief print nothing. The dynamic linker finds
/// these two functions in this module before those of libpng, so OpenImageIO calls them. They call
/// libpng's own functions with silent handlers. The error itself still reaches OpenImageIO by
/// libpng's jump. If a program has loaded libpng itself, the linker finds that first, and errors
/// are printed.
extern "C" __attribute__((visibility("default"))) void* png_create_read_struct(const char* version,
                                                                               void*, Handler,
                                                                               Handler) {
    const auto create = in_libpng<Create>("png_create_read_struct");
    return create == nullptr ? nullptr : create(version, nullptr, jump_out, ignore_message);
}

extern "C" __attribute__((visibility("default"))) void png_set_error_fn(void* png, void* receiver,
                                                                        Handler, Handler) {
    if (const auto set = in_libpng<SetHandlers>("png_set_error_fn"))
        set(png, receiver, jump_out, ignore_message);
}

/// Keeps the output independent of the clock. If writing a TIFF takes more than five seconds,
/// OpenImageIO 2.4 asks libtiff for a checkpoint of the directory, so that the same image gives
/// different files. relief writes temporary files and renames them when they are complete, so
/// checkpoints have no use. The linker finds this function before that of libtiff. The directory is
/// written once, when the file is closed.
extern "C" __attribute__((visibility("default"))) int TIFFCheckpointDirectory(void*) {
    return 1;  // libtiff's value for success.
}

// --- The functions of the module ---

namespace relief::detail {

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

/// Runs `body` and converts exceptions to text; the result is `otherwise` then.
template <typename Result, typename Body>
Result guarded(const ImageModuleFailure& failure, Result otherwise, Body body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        fail(failure, "takes more memory than is permitted");
    } catch (const std::exception& error) {
        fail(failure, error.what());
    } catch (...) {
        fail(failure, "an unknown kind of exception");
    }
    return otherwise;
}

/// Returns the pending message of a reader or writer, or the library's own one. A message of libpng
/// is preferred, because it has more details.
template <typename File>
std::string pending_error(File& file) {
    const std::string text = file.has_error() ? file.geterror() : OIIO::geterror();
    const std::string last_message = take_png_message();
    return last_message.empty() ? text : "PNG: " + last_message;
}

OIIO::TypeDesc sample_type(int bits) {
    if (bits == 8) return OIIO::TypeDesc::UINT8;
    if (bits == 16) return OIIO::TypeDesc::UINT16;
    return OIIO::TypeDesc::FLOAT;
}

/// 8 or 16 if all channels are unsigned integers of that size, otherwise 32.
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

/// Reads a file by its descriptor, which OpenImageIO's own class cannot do without a name.
class Descriptor final : public OIIO::Filesystem::IOProxy {
  public:
    explicit Descriptor(int descriptor) : IOProxy("", Read), descriptor_(descriptor) {
        struct stat facts {};
        if (::fstat(descriptor, &facts) == 0) size_ = static_cast<std::size_t>(facts.st_size);
    }
    [[nodiscard]] const char* proxytype() const override { return "file"; }
    bool seek(std::int64_t offset) override {
        m_pos = offset;
        return true;
    }
    std::size_t read(void* bytes, std::size_t size) override {
        const std::size_t got = pread(bytes, size, m_pos);
        m_pos += static_cast<std::int64_t>(got);
        return got;
    }
    std::size_t pread(void* bytes, std::size_t size, std::int64_t offset) override {
        std::size_t done = 0;
        while (done < size) {
            const ssize_t got = ::pread(descriptor_, static_cast<char*>(bytes) + done, size - done,
                                        offset + static_cast<std::int64_t>(done));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) break;
            done += static_cast<std::size_t>(got);
        }
        return done;
    }
    [[nodiscard]] std::size_t size() const override { return size_; }

  private:
    int descriptor_;
    std::size_t size_ = 0;
};

/// Opens an image from a proxy.
ImageModuleReader* open_proxy(const char* format, std::unique_ptr<OIIO::Filesystem::IOProxy> bytes,
                              ImageModuleHeader* header, ImageModuleText text,
                              ImageModuleFailure failure) {
    auto reader = std::make_unique<ImageModuleReader>();
    reader->bytes = std::move(bytes);
    reader->input = OIIO::ImageInput::create(format);
    if (!reader->input) return fail(failure, OIIO::geterror()), nullptr;
    // In OpenImageIO 2.4, opening with both a configuration and a proxy fails; setting the proxy
    // first works.
    if (!reader->input->set_ioproxy(reader->bytes.get()))
        return fail(failure, "this format cannot be read from memory"), nullptr;
    OIIO::ImageSpec request;
    request["oiio:UnassociatedAlpha"] = 1;
    OIIO::ImageSpec spec;
    if (!reader->input->open(std::string("image.") + format, spec, request))
        return fail(failure, pending_error(*reader->input)), nullptr;
    if (spec.deep || spec.depth > 1)
        return fail(failure, "contains a volume or deep samples"), nullptr;
    reader->header = {spec.width, spec.height, spec.nchannels, bits_of(spec)};
    *header = reader->header;
    hand_out_text(spec, text);
    return reader.release();
}

void use_one_thread() {
    OIIO::attribute("threads", 1);
    // OpenEXR has threads of its own. -1 means none, while 0 would mean one per processor.
    OIIO::attribute("exr_threads", -1);
}

ImageModuleReader* open(const char* format, const void* bytes, std::size_t size,
                        ImageModuleHeader* header, ImageModuleText text,
                        ImageModuleFailure failure) {
    return guarded<ImageModuleReader*>(failure, nullptr, [&] {
        return open_proxy(format, std::make_unique<OIIO::Filesystem::IOMemReader>(bytes, size),
                          header, text, failure);
    });
}

ImageModuleReader* open_descriptor(const char* format, int descriptor, ImageModuleHeader* header,
                                   ImageModuleText text, ImageModuleFailure failure) {
    return guarded<ImageModuleReader*>(failure, nullptr, [&] {
        return open_proxy(format, std::make_unique<Descriptor>(descriptor), header, text, failure);
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
        // A truncated file may be read with success while an error is pending.
        if (read && !input.has_error()) return true;
        fail(failure, pending_error(input));
        return false;
    });
}

void close(ImageModuleReader* reader) {
    try {
        delete reader;
    } catch (...) {
        // A reader writes nothing, so an error while closing has no consequence.
        return;
    }
}

/// Returns the settings for all formats that relief writes.
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
    // Plain TIFF has 32-bit offsets, and the compressed size is unknown.
    constexpr std::uint64_t large = 0xF0000000;
    if (format == "tiff" && spec.image_bytes(true) >= large) spec["tiff:bigtiff"] = 1;
    // OpenImageIO 2.4 treats some of its own entries as Exif and then cannot write them.
    if (format == "tiff") spec["tiff:write_exif"] = 0;
    // Without this the date would be written, and the file would differ each time.
    if (format == "tiff" || format == "openexr") spec["DateTime"] = "";
    if (format == "jpeg") {
        spec["compression"] = "jpeg:95";
        spec["jpeg:subsampling"] =
            "4:4:4";  // Chroma subsampling would mix neighboring texels of data maps.
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
        // The file is already complete or abandoned.
        return;
    }
}

constexpr ImageModule table{image_module_version,
                            use_one_thread,
                            open,
                            open_descriptor,
                            row_grain,
                            read,
                            close,
                            create,
                            write,
                            finish,
                            release};

}  // namespace
}  // namespace relief::detail

extern "C" __attribute__((visibility("default"))) const relief::detail::ImageModule*
relief_image_module() {
    return &relief::detail::table;
}
