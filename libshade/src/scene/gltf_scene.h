// SPDX-License-Identifier: Apache-2.0
/// \file
/// A glTF document as a scene graph. Tests: tests/shade/scene/scene_file_test.cpp.
#pragma once

#include <filesystem>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"

namespace relief {

/// The document's default scene, nothing posed yet; see load_scene_graph for what is translated and
/// how. \throws InvalidInput if a primitive cannot be read
///
/// \param model  the document's file, for messages
SceneGraph graph_from(const GltfDocument& document, const std::filesystem::path& model,
                      const SceneOptions& options, Report& report);

}  // namespace relief
