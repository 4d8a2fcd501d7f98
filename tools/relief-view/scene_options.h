// SPDX-License-Identifier: Apache-2.0
/// \file
/// Composes a scene and a camera from a model file and options: maps, materials, highlights,
/// reflection, environment, lights and camera.
///
/// Missing options come from the model. Properties that the model lacks too get a default, which
/// the notes report. Tests: tests/tools/scene_options_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "common/options.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_fields.h"
#include "relief/shade/scene_graph.h"
#include "view_options.h"

namespace relief::tools {

// The model: its axes and normals.

void add_model_options(CLI::App& app, ViewOptions& options);

/// The options with which the model file is read.
shade::SceneOptions scene_options(const ViewOptions& options);

/// A scene with its camera, ready to be drawn.
struct ComposedScene {
    shade::SceneGraph graph;
    shade::Camera camera;
    bool camera_follows_scene = false;  ///< The camera belongs to the scene and may move.
    std::vector<std::string> notes;     ///< Messages for the summary.

    // The transformations of all instances and the rotation center, for turntables.
    std::vector<glm::mat4> at_rest;
    glm::vec3 middle{0.0F};

    shade::Scene& scene() { return graph.scene; }
    [[nodiscard]] const shade::Scene& scene() const { return graph.scene; }
};

/// Reads the model and applies the options.
///
/// \param options  settled (view_options.h); without --size, the size becomes that of the scene
///                 file
/// \throws FileError if a file cannot be read, has no triangles, or lacks data that an option needs
/// \throws UsageError if an option would have no effect in this scene
ComposedScene compose_scene(ViewOptions& options, Stages& stages, Report& report);

/// Returns the number of triangles of all instances.
std::size_t triangle_count(const shade::Scene& scene);

}  // namespace relief::tools
