// SPDX-License-Identifier: Apache-2.0
/// \file
/// The image module from the side of libmesh: loading it, and reading and writing image files with
/// it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/image/image_file_container.h"
#include "io/image/image_module.h"
#include "io/image/row_codec.h"

namespace relief::detail {

/// Returns the folders of the image module and of the decoder program, in the order of the search:
/// $RELIEF_MODULE_DIR, beside the shared library, in the tree of the program, and in the run path
/// of the library or program, which a program gets that links the installed static library.
std::vector<std::filesystem::path> image_module_folders();

/// Returns the module, which is loaded by the first call and stays loaded until the program ends.
///
/// It is only used to write files; files are read in another process (decoder_process.h). A failure
/// is not remembered: the next call tries again.
///
/// \param file  the file that needs the module, for messages
/// \throws FileError if the module is in none of the folders, cannot be loaded, or has another
/// version
const ImageModule& image_module(const std::filesystem::path& file);

/// Bytes that are exchanged with the module in one call.
inline constexpr std::size_t module_bytes_per_band = std::size_t{1} << 23;

/// Stores the module's error message in `reason`.
inline ImageModuleFailure failure_into(std::string& reason) {
    return {&reason, [](void* receiver, const char* text) {
                // The first line is sufficient; decoders like to add more.
                const std::string_view all(text);
                static_cast<std::string*>(receiver)->assign(all.substr(0, all.find('\n')));
            }};
}

/// Rows of a TIFF or EXR file, decoded on demand.
/// \throws FileError as read_image() does
std::unique_ptr<RowSource> open_module_rows(const std::filesystem::path& file);

/// Rows of an encoded image of any format in memory, which must outlive them.
/// \param container  the result of examine_image()
std::unique_ptr<RowSource> module_rows(const ImageContainer& container,
                                       std::span<const std::byte> bytes,
                                       const std::filesystem::path& name);

/// Reads a whole image with the module only; the reference for the other decoders.
/// \throws FileError
Image read_by_module(const std::filesystem::path& file);

}  // namespace relief::detail
