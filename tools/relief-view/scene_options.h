// SPDX-License-Identifier: Apache-2.0
/// \file
/// From a model file and options to a scene and a camera that sees it.
///
/// What the options do not say comes from the model; what the model does not say either gets a
/// pleasant default, of which the notes tell. Tests: tests/tools/scene_options_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene_graph.h"
#include "view_options.h"

namespace relief::tools {

struct ComposedScene {
    SceneGraph graph;
    Camera camera;
    bool camera_follows_scene = false;  ///< The scene's own camera, which may move.
    std::vector<std::string> notes;     ///< What was added or could not be done, for the summary.

    // For turntables: what turns, where it stands, and about what.
    std::vector<glm::mat4> at_rest;
    glm::vec3 middle{0.0F};

    Scene& scene() { return graph.scene; }
    [[nodiscard]] const Scene& scene() const { return graph.scene; }
};

/// \param options  settled (view_options.h); a size that was not given becomes the scene file's
/// \throws FileError if a file cannot be read, holds no triangles, or lacks what an option needs;
///         UsageError if an option could show nowhere in this scene
ComposedScene compose_scene(ViewOptions& options, Stages& stages, Report& report);

}  // namespace relief::tools
