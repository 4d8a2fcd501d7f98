// SPDX-License-Identifier: Apache-2.0
/// \file
/// A normal map as it comes: its texels, and what its numbers mean by the command line, by what its
/// file says, or by what it shows. Tests: tests/tools/convert_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// What the command line says about a map.
struct MapInputOptions {
    std::optional<Green> green;
    bool finds_green = false;  ///< By the slopes of the map: `auto`.
    std::optional<FlatCode> flat;
    bool is_signed = false;  ///< Float samples hold n itself, not (n + 1) / 2.
};

struct InputMap {
    Image image;  ///< Float samples hold (n + 1) / 2, however they were stored.
    std::map<std::string, std::string> metadata;
    std::optional<Green> green;  ///< Absent where nobody says, and nobody asks the map.
    FlatCode flat = FlatCode::half;
    std::string words;  ///< "green down (as told), zero is 127.5 of 255 (as its file says)"
};

/// \throws FileError if it cannot be read, has too few channels to be a normal map, or cannot tell
///         its green where that is asked of it
InputMap read_normal_map(const std::filesystem::path& file, const MapInputOptions& options);

/// The text entries that a converted map keeps: who made it and what it shows, and relief's own.
std::map<std::string, std::string> kept_metadata(const std::map<std::string, std::string>& all);

}  // namespace relief::tools
