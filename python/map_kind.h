// SPDX-License-Identifier: Apache-2.0
// Refuses arrays that are maps of the wrong kind, as the command lines refuse files
// (relief/mesh/map_kind_check.h). Tests: tests/python/test_arrays.py.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "relief/mesh/image.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace relief::python {

/// Refuses a map whose texels show another kind. Arrays state none.
/// \param name      of the argument, for the message
/// \param accepted  the kinds that it may have
/// \param assume    the name of the first one, which accepts any texels
/// \throws InvalidInput if the texels clearly show another kind, or `assume` is another name
void check_kind(const ImageView& map, const char* name, const std::vector<MapKind>& accepted,
                const std::optional<std::string>& assume);

/// Returns the kinds of names in `assume`, as those of `relief-view --assume`.
std::vector<MapKind> assumed_kinds(const std::vector<std::string>& names);

/// Refuses a scene whose file names a map that is of the wrong kind, by its metadata or else by its
/// texels. Images that cannot be read are left to the renderer.
/// \throws FileError with the scene file, the material, the texture and the map
void check_scene_maps(const shade::Scene& scene, const std::filesystem::path& file,
                      const std::vector<MapKind>& assumed);

/// Returns a report without the findings about maps that are drawn as an assumed kind.
Report without_assumed(const Report& report, const std::vector<MapKind>& assumed);

}  // namespace relief::python
