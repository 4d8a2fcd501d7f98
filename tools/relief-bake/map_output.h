// SPDX-License-Identifier: Apache-2.0
/// \file
/// How a normal map is to be written: options that all commands with one as their result have.
/// Tests: tests/tools/relief_bake_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/command.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// What the command line says; absent: what suits the format of the file.
struct MapOutputOptions {
    std::optional<int> bits;
    Green green = Green::up;
    std::optional<FlatCode> flat;
};

/// --bits, --green, --flat
void add_map_output_options(CLI::App& app, MapOutputOptions& options);

/// Whether files of this name can be normal maps: .png .tif .tiff .exr.
bool can_hold_normals(const std::filesystem::path& file);

/// \throws UsageError if the file is of a format that cannot hold normals, or not in that depth
NormalMapFormat format_of(const MapOutputOptions& options, const std::filesystem::path& output);

/// "16 bit, flat is the middle code, green up"
std::string format_words(const NormalMapFormat& format);

}  // namespace relief::tools
