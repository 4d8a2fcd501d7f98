// SPDX-License-Identifier: Apache-2.0
/// \file
/// Saves an edited scene as a scene file (docs/scene-files.md) that draws the same pixels.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>

#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"

namespace relief {

/// A scene that was read from a file, with a camera and a picture size.
struct SceneToSave {
    std::filesystem::path source;  ///< The model or scene file.
    const Scene& scene;            ///< The edited scene: lights, environment, materials.
    Camera camera;
    glm::ivec2 size{1024, 1024};
};

/// Writes a scene file that names the model, or repeats the scene file, with the differences:
/// fields of materials, all lights if any changed, the environment and the camera.
///
/// Changed lights do not move any more. Images in memory (a converted height map) are written
/// beside the file as PNG: NAME-image-1.png, and so on.
/// \throws FileError if the source cannot be read again, or a file cannot be written or exists
///         already; InvalidInput if a scene file cannot express the change: meshes were moved or
///         added, a scene file is written to another folder, or an environment is no file
void save_scene(const std::filesystem::path& file, const SceneToSave& saved);

}  // namespace relief
