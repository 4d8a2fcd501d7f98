// SPDX-License-Identifier: Apache-2.0
/// \file
/// An edited scene as a scene file (docs/scene-files.md) that draws the same pixels.
/// Tests: tests/tools/window/saving_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>

#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"

namespace relief {

/// A scene that came from a file, and how it is to be seen.
struct SceneToSave {
    std::filesystem::path source;  ///< The model or scene file.
    const Scene& scene;            ///< What was made of it: lights, surroundings, materials.
    Camera camera;
    glm::ivec2 size{1024, 1024};
};

/// Writes a scene file that names the model, or repeats the scene file, and says what is different:
/// materials member by member, all lights if any changed, surroundings, camera.
///
/// Lights that moved stand still from then on. Images that were made here (a converted height map)
/// are written beside it as PNG: NAME-image-1.png, and so on.
/// \throws FileError if the source cannot be read again or a file cannot be written or is there
///         already; InvalidInput where a scene file could not say it: meshes were moved or added, a
///         scene file is to be written to another folder, or an environment is no file
void save_scene(const std::filesystem::path& file, const SceneToSave& saved);

}  // namespace relief
