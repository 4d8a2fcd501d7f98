// SPDX-License-Identifier: Apache-2.0
/// \file
/// How a normal map is to be written: options that all commands with one as their result have.
/// Tests: tests/tools/relief_bake_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// What the command line says; absent: what the command does unless told otherwise.
struct MapOutputOptions {
    std::optional<int> bits;
    std::optional<Green> green;
    std::optional<FlatCode> flat;
    std::optional<Dither> dither;
    bool half = false;   ///< --half
    bool fast = false;   ///< --fast
    bool small = false;  ///< --small
};

/// What a command does unless told otherwise, and how its --help says it.
struct MapOutputDefaults {
    std::optional<int>
        bits{};  ///< Absent, or not among what the format holds: its greatest below 32.
    Green green = Green::up;
    FlatCode flat = FlatCode::half;
};

/// --bits, --green, --zero-code, --dither, --half, --fast, --small.
///
/// \param follows_input  whether the defaults are what the input has, for --help
void add_map_output_options(CLI::App& app, MapOutputOptions& options, bool follows_input = false);

/// The depths that a format can hold normals in, the first being the one to use unless asked; none
/// where it can hold none.
std::vector<int> depths_of(const std::filesystem::path& output);

/// Whether files of this name can be normal maps: .png .tif .tiff .exr.
bool can_hold_normals(const std::filesystem::path& file);

/// \throws UsageError if the file is of a format that cannot hold normals, or not in that depth; if
///         an option has no effect on it
NormalMapFormat format_of(const MapOutputOptions& options, const std::filesystem::path& output,
                          const MapOutputDefaults& defaults = {});

/// \throws UsageError if the options contradict each other, or have no effect on such a file
ImageWriteOptions write_options_of(const MapOutputOptions& options,
                                   const std::filesystem::path& output);

/// "8 bit, zero at 127.5 of 255 (as glTF and engines decode; ...), green up"
std::string format_words(const NormalMapFormat& format);

}  // namespace relief::tools
