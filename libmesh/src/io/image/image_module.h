// SPDX-License-Identifier: Apache-2.0
/// \file
/// The table of functions between libmesh and the image module, the only shared library that uses
/// OpenImageIO. It has plain C types; exceptions and allocations do not cross it.
///
/// Functions return whether they succeeded, and call `fail` with one line of text if not. Samples
/// are rows of interleaved channels from the top, tightly packed, in native byte order.
#pragma once

#include <cstddef>
#include <cstdint>

namespace relief::detail {

/// The version of this interface; it changes with every change here. Modules of other versions are
/// refused.
inline constexpr std::uint32_t image_module_version = 5;

inline constexpr const char* image_module_name = "relief_image.so";

/// The name of the module's only exported function: `const ImageModule* relief_image_module()`.
inline constexpr const char* image_module_entry = "relief_image_module";

/// Receives the reason of a failure. `text` is valid only during the call.
struct ImageModuleFailure {
    void* receiver = nullptr;
    void (*fail)(void* receiver, const char* text) = nullptr;
};

/// Receives text entries. Both strings are valid only during the call.
struct ImageModuleText {
    void* receiver = nullptr;
    void (*entry)(void* receiver, const char* key, const char* value) = nullptr;
};

struct ImageModuleHeader {
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::int64_t channels = 0;
    std::int32_t bits = 0;  ///< Of samples from read(): 8, 16 or 32 (float).
};

/// An image that is being read; private to the module.
struct ImageModuleReader;

/// An image that is being written; private to the module.
struct ImageModuleWriter;

/// The properties of an image to be written.
struct ImageModulePicture {
    ImageModuleHeader header;
    bool srgb = false;    ///< Label it as sRGB if the format has such a label.
    bool half = false;    ///< Store float samples as half floats.
    int zip_quality = 1;  ///< 1 (fast) to 9 (small), for formats that use deflate.
    const char* const* channel_names =
        nullptr;  ///< One for each channel; null for gray, RGB and alpha.
    const char* const* keys = nullptr;
    const char* const* values = nullptr;
    std::size_t text_count = 0;
};

struct ImageModule {
    std::uint32_t version;

    /// Makes the module start no threads.
    void (*use_one_thread)();

    /// Opens encoded bytes, which must outlive the reader, and reads their header. `format` is
    /// OpenImageIO's name for it. Null after a failure.
    ImageModuleReader* (*open)(const char* format, const void* bytes, std::size_t size,
                               ImageModuleHeader* header, ImageModuleText text,
                               ImageModuleFailure failure);

    /// Opens a file by its descriptor, which must stay open as long as the reader.
    ImageModuleReader* (*open_descriptor)(const char* format, int descriptor,
                                          ImageModuleHeader* header, ImageModuleText text,
                                          ImageModuleFailure failure);

    /// The row granularity of read(): 1, or the height of a tile.
    std::int64_t (*row_grain)(ImageModuleReader* reader);

    /// Decodes rows [first, end). Both are multiples of the row granularity, except that `end` may
    /// be the height.
    bool (*read)(ImageModuleReader* reader, std::int64_t first, std::int64_t end, void* samples,
                 ImageModuleFailure failure);

    void (*close)(ImageModuleReader* reader);

    /// Creates a file; `format` is OpenImageIO's name for it. Null after a failure.
    ImageModuleWriter* (*create)(const char* format, const char* path,
                                 const ImageModulePicture* picture, ImageModuleFailure failure);

    /// Writes rows [first, end), which must follow the previous ones.
    bool (*write)(ImageModuleWriter* writer, std::int64_t first, std::int64_t end,
                  const void* samples, ImageModuleFailure failure);

    /// Completes a file after all rows.
    bool (*finish)(ImageModuleWriter* writer, ImageModuleFailure failure);

    /// Frees the writer, also that of an incomplete file.
    void (*release)(ImageModuleWriter* writer);
};

}  // namespace relief::detail
