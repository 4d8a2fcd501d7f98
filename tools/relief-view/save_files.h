// SPDX-License-Identifier: Apache-2.0
/// \file
/// What is shown, saved: the scene as a scene file, the model as glTF with the frames that it is
/// drawn with (--save-scene, --save-model, and the window's keys).
/// Tests: tests/tools/window/saving_test.cpp.
#pragma once

#include "scene_options.h"

namespace relief::tools {

void add_save_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if a file has no format to be written in, or would overwrite the model
void check_save_options(const ViewOptions& options);

/// Writes the files that the options name.
void save_files(const ViewOptions& options, const ComposedScene& composed, Stages& stages);

/// Writes a model with normals where it has none, and with tangents where a normal map asks for
/// them; what it has stays as it is. Materials of other formats become glTF's.
/// \param file  .glb or .gltf
/// \throws FileError if a file cannot be read or written; InvalidInput if the model is a scene file
void save_model(const std::filesystem::path& file, const std::filesystem::path& model);

}  // namespace relief::tools
