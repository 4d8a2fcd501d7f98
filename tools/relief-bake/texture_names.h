// SPDX-License-Identifier: Apache-2.0
/// \file
/// The kinds of maps by the names of their files: "rock_normal.png", "Rock_BaseColor.png".
/// Tests: tests/tools/texture_names_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// A map by its name.
struct NamedMap {
    /// Absent: unknown, or `problem` says why it is not certain.
    std::optional<MapKind> kind;
    bool is_smoothness = false;  ///< Of `roughness`: the map has 1 - roughness.
    bool has_occlusion = true;   ///< Of `packed`: the red channel has occlusion.
    bool is_unity_mask = false;  ///< Of `packed`: metalness, occlusion, detail, smoothness.
    std::optional<Green> green;  ///< If the name says it.
    std::string set;             ///< The name without the word of the kind: "rock".
    std::string problem;         ///< "the word 'depth' may be heights or their opposite"
};

/// Reads the name of a file without its extension.
///
/// The name is divided at '_', '-', '.', spaces and changes from lower to upper case. The last
/// word, or the last ones together, name the kind; words for sizes and file formats ("1K", "2048",
/// "PNG") do not count.
NamedMap named_map(const std::string& stem);

}  // namespace relief::tools
