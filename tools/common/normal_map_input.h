// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reads a normal map with its conventions, which are given by the command line or the file, or are
/// detected. Tests: tests/tools/relief_bake_convert_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/map_kind.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// The conventions given on the command line.
struct MapInputOptions {
    std::optional<Green> green;
    bool detects_green = false;  ///< `auto`: green is detected from the slopes of the map.
    std::optional<FlatCode> flat;
    bool is_signed = false;  ///< Float samples are n instead of (n + 1) / 2.
    /// The kinds that are accepted.
    std::vector<MapKind> accepted = {MapKind::normal, MapKind::object_normal,
                                     MapKind::world_normal};
    AssumedKinds assumed;
    bool needs_z = true;
    bool judges_texels = true;  ///< False if the components are not in the first three channels.
};

/// Adds an option for the direction of green: up, down or auto.
AddedOption add_green_choice(CLI::App& app, const std::string& name, MapInputOptions& input,
                             const std::string& description);

struct InputMap {
    /// Float samples are converted to (n + 1) / 2. Empty if open_normal_map() leaves them in the
    /// file.
    Image image;
    ImageInfo info;
    std::map<std::string, std::string> metadata;
    std::optional<Green> green;  ///< Absent if it is neither given nor detected.
    FlatCode flat = FlatCode::half;
    /// "green down (given), zero is 127.5 of 255 (from its metadata)"
    std::string conventions;
};

/// \throws FileError if the file cannot be read, has too few channels for a normal map, is of
/// another kind, or if detecting green fails
InputMap read_normal_map(const std::filesystem::path& file, const MapInputOptions& options);

/// The same, but leaves the samples in files that are too large and can be read by rows.
/// \param max_memory  bytes of samples that are read; all if green is detected
InputMap open_normal_map(const std::filesystem::path& file, const MapInputOptions& options,
                         std::size_t max_memory);

/// \throws FileError if the metadata of a map say that its third channel is not z
void require_z(const std::filesystem::path& file, const InputMap& map);

/// Returns the text entries that a converted map keeps: author, description, and those of relief.
std::map<std::string, std::string> kept_metadata(const std::map<std::string, std::string>& all);

}  // namespace relief::tools
