// SPDX-License-Identifier: Apache-2.0
/// \file
/// The table of functions between libmesh and the image module, the one shared library that knows
/// OpenImageIO. Plain C types, no exceptions, no allocation handed across.
///
/// Every function returns whether it succeeded; where it did not, it has called `fail` with one
/// line of text. Samples are rows of interleaved channels from the top, tightly packed, in the
/// machine's byte order. Tests: tests/mesh/io/image/image_file_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>

namespace relief {

/// Changes whenever anything in this file does; a module of another version is refused.
inline constexpr std::uint32_t image_module_version = 3;

/// The name of the module's one exported function: `const ImageModule* relief_image_module()`.
inline constexpr const char* image_module_entry = "relief_image_module";

/// Where the callee says why it failed. `text` lives only during the call.
struct ImageModuleFailure {
    void* receiver = nullptr;
    void (*fail)(void* receiver, const char* text) = nullptr;
};

/// Where the callee hands out text entries. Both strings live only during the call.
struct ImageModuleText {
    void* receiver = nullptr;
    void (*entry)(void* receiver, const char* key, const char* value) = nullptr;
};

struct ImageModuleHeader {
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::int64_t channels = 0;
    std::int32_t bits = 0;  ///< 8, 16 or 32 (float): what read() gives.
};

/// An image being read; the module's own.
struct ImageModuleReader;

/// An image being written; the module's own.
struct ImageModuleWriter;

/// What to write, and how to label it.
struct ImageModulePicture {
    ImageModuleHeader header;
    bool srgb = false;    ///< Label as sRGB where the format can say so.
    bool half = false;    ///< Store float samples as half floats.
    int zip_quality = 1;  ///< 1 (fast) to 9 (small), where the format deflates.
    const char* const* channel_names = nullptr;  ///< As many as channels; null: grey, RGB, alpha.
    const char* const* keys = nullptr;
    const char* const* values = nullptr;
    std::size_t text_count = 0;
};

struct ImageModule {
    std::uint32_t version;

    /// Opens encoded bytes, which must outlive the reader. `format` is OpenImageIO's name for it.
    /// Only headers are looked at. Null where it failed.
    ImageModuleReader* (*open)(const char* format, const void* bytes, std::size_t size,
                               ImageModuleHeader* header, ImageModuleText text,
                               ImageModuleFailure failure);

    /// Opens a file.
    ImageModuleReader* (*open_file)(const char* format, const char* path, ImageModuleHeader* header,
                                    ImageModuleText text, ImageModuleFailure failure);

    /// The least number of rows that read() may be asked for at once: 1, or the height of a tile.
    std::int64_t (*row_grain)(ImageModuleReader* reader);

    /// Decodes rows [first, end); `first` is a multiple of the row grain, and so is `end` unless it
    /// is the height.
    bool (*read)(ImageModuleReader* reader, std::int64_t first, std::int64_t end, void* samples,
                 ImageModuleFailure failure);

    void (*close)(ImageModuleReader* reader);

    /// Begins a file, by OpenImageIO's name for its format. Null where it failed.
    ImageModuleWriter* (*create)(const char* format, const char* path,
                                 const ImageModulePicture* picture, ImageModuleFailure failure);

    /// Takes rows [first, end), which follow those before.
    bool (*write)(ImageModuleWriter* writer, std::int64_t first, std::int64_t end,
                  const void* samples, ImageModuleFailure failure);

    /// Ends a file of which all rows are written.
    bool (*finish)(ImageModuleWriter* writer, ImageModuleFailure failure);

    /// Frees the writer, whether it came to an end or not.
    void (*release)(ImageModuleWriter* writer);
};

}  // namespace relief
