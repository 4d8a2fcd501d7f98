// SPDX-License-Identifier: Apache-2.0
/// \file
/// A field for the path of a file. Tests: tests/tools/window/panels_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace relief::tools {

/// What a field was asked for.
struct FileChoice {
    std::optional<std::filesystem::path> file;  ///< Typed or pasted, and Enter.
    bool is_cleared = false;                    ///< By its button, which is there where a file is.
};

/// \param shown  what is there now, in words; absent: nothing
FileChoice file_field(const char* label, const std::optional<std::string>& shown);

}  // namespace relief::tools
