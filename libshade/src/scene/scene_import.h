// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of load_scene_graph (scene_file.h): one function for each kind of file, and what their
/// materials share.
#pragma once

#include <algorithm>
#include <filesystem>
#include <glm/glm.hpp>

#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_file.h"

namespace relief {

/// The default scene of a glTF document, not posed yet.
///
/// \param model  the document's file, for messages
/// \throws InvalidInput if a primitive cannot be read
SceneGraph graph_from(const GltfDocument& document, const std::filesystem::path& model,
                      const SceneOptions& options, Report& report);

/// The scene of a scene file (docs/scene-files.md), neither validated nor posed for rendering.
///
/// \throws FileError if the file, or a file that it names, is missing or invalid; problems of the
///         scene file itself are named by their JSON pointer
SceneGraph read_scene_json(const std::filesystem::path& file, const SceneOptions& options,
                           Report& report);

/// The number of a foreign material as a scene allows it: within [0, limit]; NaN counts as 0.
inline float usable(float value, float limit) {
    return value > 0.0F ? std::min(value, limit) : 0.0F;
}

inline glm::vec3 usable(const glm::vec3& color, float limit) {
    return {usable(color.r, limit), usable(color.g, limit), usable(color.b, limit)};
}

/// The mean color of an image, for a material model that has no place for its texture. Colors are
/// averaged in linear light, data as they are. Every texel has the same weight, and alpha is
/// ignored. The mean is taken in double in row order, so it is the same bits every time.
///
/// \return red, green, blue (gray three times); non-finite samples are left out, and the mean of an
///         image without finite samples is 1
glm::vec3 mean_color(const Image& image);

}  // namespace relief
