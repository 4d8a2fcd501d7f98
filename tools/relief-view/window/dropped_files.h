// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a file that was dropped on the window is taken for.
/// Tests: tests/tools/window/dropped_files_test.cpp.
#pragma once

#include <filesystem>
#include <vector>

#include "view_options.h"

namespace relief::tools {

enum class DroppedAs { model, height_map, normal_map, diffuse_map, environment };

/// By its kind and name: models and scenes by their endings; .hdr, and folders, are surroundings;
/// an image is a normal map, heights or surroundings where its name says so ("normal", "nrm",
/// "_n"; "height", "bump", "disp", "_h"; "env", "pano", "sky"), and a diffuse map where it does
/// not.
DroppedAs dropped_as(const std::filesystem::path& file);

/// The options that show what was dropped at once: a model takes the place of the model, a map that
/// of such a map. Six images are the faces of a cube, by the ends of their names ("posx", "px" or
/// "right", and so on) or else in the order of their names.
ViewOptions with_dropped(ViewOptions options, const std::vector<std::filesystem::path>& files);

}  // namespace relief::tools
