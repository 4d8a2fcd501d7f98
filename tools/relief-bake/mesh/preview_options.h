// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether a picture is wanted as well, and of what size. Tests: tests/tools/mesh_preview_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "common/command.h"

namespace relief::tools {

/// What the command line says.
struct PreviewOptions {
    std::optional<std::filesystem::path> file;
    std::optional<glm::ivec2> size;  ///< Of each panel.
};

/// --preview, --preview-size.
void add_preview_options(CLI::App& app, PreviewOptions& options);

/// \param files  what the command reads or writes otherwise
/// \throws UsageError if the picture is of another format than PNG or is one of these files, or if
///         an option has no effect; FileError if there is no folder to write it in
void check(const PreviewOptions& options, const std::vector<std::filesystem::path>& files);

}  // namespace relief::tools
