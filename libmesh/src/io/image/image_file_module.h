// SPDX-License-Identifier: Apache-2.0
/// \file
/// Finding and loading the image module, once and at the first need.
/// Tests: tests/mesh/io/image/image_file_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/image/image_module.h"

namespace relief {

/// The module, loaded now if it was not yet; it stays until the program ends.
///
/// Looked for in $RELIEF_MODULE_DIR, then in ../lib/relief beside the running program. A failure is
/// not remembered: the next call tries again.
///
/// \param file  what it is needed for, for the message
/// \throws FileError if it is in neither place, does not load, or is of another version
const ImageModule& image_module(const std::filesystem::path& file);

/// How much is handed to the module, or taken from it, at once.
inline constexpr std::size_t module_bytes_per_band = std::size_t{1} << 23;

/// What the module says of its failures becomes `reason`.
inline ImageModuleFailure failure_into(std::string& reason) {
    return {&reason, [](void* receiver, const char* text) {
                // The first line says it; decoders like to add more.
                const std::string_view all(text);
                static_cast<std::string*>(receiver)->assign(all.substr(0, all.find('\n')));
            }};
}

}  // namespace relief
