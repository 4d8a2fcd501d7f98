// SPDX-License-Identifier: Apache-2.0
/// \file
/// Scene files: JSON as docs/scene-files.md describes it. Tests:
/// tests/shade/scene/scene_json_test.cpp.
#pragma once

#include <filesystem>

#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"

namespace relief {

/// The file's scene, to be posed and validated by load_scene_graph. \throws FileError if it, or a
/// file that it names, is not there or not as it must be; what is wrong in the scene file itself is
/// named by its JSON pointer
SceneGraph read_scene_json(const std::filesystem::path& file, const SceneOptions& options,
                           Report& report);

}  // namespace relief
