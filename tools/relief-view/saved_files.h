// SPDX-License-Identifier: Apache-2.0
/// \file
/// The files of --save-scene and --save-model. Tests: tests/tools/window/capture_test.cpp,
/// tests/tools/relief_view_test.cpp.
#pragma once

#include <filesystem>

#include "common/command.h"
#include "scene_options.h"
#include "view_options.h"

namespace relief::tools {

void add_save_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if the format of a file is not supported
void check_save_options(const ViewOptions& options);

/// Writes the files of --save-scene and --save-model.
void save_files(const ViewOptions& options, const ComposedScene& composed, Stages& stages);

/// Writes a model. Missing normals are added, and so are tangents if a normal map needs them. Other
/// data stays. Materials of other formats become glTF materials.
///
/// \param file     .glb or .gltf
/// \param options  for the normals and the axis that points up
/// \throws FileError if a file cannot be read or written
/// \throws InvalidInput if the model is a scene file
void save_model(const std::filesystem::path& file, const std::filesystem::path& model,
                const shade::SceneOptions& options = {});

}  // namespace relief::tools
