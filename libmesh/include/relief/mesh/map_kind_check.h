// SPDX-License-Identifier: Apache-2.0
/// \file
/// Compares the kind of a map with the kinds that its use accepts. The metadata of a file
/// (map_description.h) decide; without them, the texels show only whether an image is clearly no
/// normal map, or is one although heights are expected.
/// Tests: tests/mesh/image/map_kind_check_test.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/image.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/material.h"
#include "relief/mesh/normal_map_check.h"
#include "relief/mesh/report.h"

namespace RELIEF_API relief {

/// The kind of a map that is not accepted.
struct WrongMapKind {
    std::optional<MapKind> kind;  ///< Absent: colors, or several masks.
    std::string problem;          ///< A predicate: "is a height map, as its metadata say".
};

/// Returns the kinds of maps that a texture slot accepts, the usual one first. None for a slot that
/// accepts any map, because its channels may be packed in many ways.
std::vector<MapKind> accepted_kinds(TextureSlot slot);

/// Returns the kinds of a map that a material draws as it is: as accepted_kinds(), but normals must
/// be in the space of the material's map.
std::vector<MapKind> drawn_kinds(const Material& material, TextureSlot slot);

/// Compares the kind that a file states.
/// \return nothing if it states none, or an accepted one
std::optional<WrongMapKind> stated_wrong_kind(std::span<const MapKind> accepted,
                                              const MapDescription& stated);

/// Returns true if texels can show that a map is not of these kinds: for normals and heights.
bool is_judged_by_texels(std::span<const MapKind> accepted);

/// Judges the content of a map whose file does not state its kind.
/// \return nothing if the file states the kind, or if the map has fewer than 64 texels
std::optional<MapContent> unstated_content(const ImageView& map, const MapDescription& stated);

/// Compares the kind that the texels show.
/// \return nothing if it is accepted, or not clearly another one; colors can be heights
std::optional<WrongMapKind> judged_wrong_kind(std::span<const MapKind> accepted,
                                              MapContent content);

/// Returns the outcome of report_drawn_kind() for maps that should be of a kind: "is drawn as a
/// height map".
std::string drawn_as(MapKind kind);

/// Reports a map that is drawn as if it were of the usual kind of its slot, with the index of its
/// material.
void report_drawn_kind(const WrongMapKind& wrong, TextureSlot slot, MapKind drawn,
                       std::size_t material, Report& report);

}  // namespace relief
