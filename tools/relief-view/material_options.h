// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options that set maps, highlights and reflection for all materials of a scene. Tests:
/// tests/tools/scene_options_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "view_options.h"

namespace relief::tools {

void add_map_options(CLI::App& app, ViewOptions& options);

void add_material_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if options contradict each other
void check_materials(const ViewOptions& options);

/// The option that requires the Phong model for glTF materials: --shading phong, or the first
/// option that only the Phong model has. Empty if there is none.
std::string reason_for_phong(const ViewOptions& options);

/// Applies the options to all materials. Meshes without a material get the default material first.
///
/// \param notes  receives messages for the user, such as meshes without texture coordinates
/// \throws UsageError if an option would have no effect
/// \throws FileError if no mesh has texture coordinates for a map, or if the height map is invalid
void override_materials(shade::Scene& scene, const ViewOptions& options, Stages& stages,
                        Report& report, std::vector<std::string>& notes);

/// Checks the kinds of the maps that the scene file of the options names.
/// \throws RefusedMap with the scene file, the material and the slot
void check_scene_maps(const shade::Scene& scene, const ViewOptions& options);

/// The height map of the options.
shade::SceneHeights scene_heights(const ViewOptions& options);

}  // namespace relief::tools
