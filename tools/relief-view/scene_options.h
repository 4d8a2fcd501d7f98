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
#include "view_options.h"

namespace relief::tools {

// Names and limits of options for scene fields, derived from the description of the fields
// (relief/shade/scene_fields.h).

template <typename Owner, typename Value>
Range field_limits(Value Owner::*member) {
    const FieldRange range = field_of(member).range;
    return {static_cast<double>(range.min), static_cast<double>(range.max), ""};
}

// The model: its axes and normals.

void add_model_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if an option has no effect on this file
void check_model(const ViewOptions& options);

/// The options with which the model file is read.
SceneOptions scene_options(const ViewOptions& options);

// Maps, materials, highlights and reflection, which the options set for all materials of a scene.

void add_map_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if an option needs another one
void check_maps(const ViewOptions& options);

void add_material_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if options contradict each other
void check_materials(const ViewOptions& options);

/// The option that requires the Phong model for glTF materials: --shading phong, or the first
/// option that only the Phong model has. Empty if there is none.
std::string reason_for_phong(const ViewOptions& options);

/// Applies the options to all materials. Meshes without a material get the default material first.
///
/// \param notes  receives messages for the user, such as meshes without texture coordinates
/// \throws UsageError if an option would have no effect
/// \throws FileError if no mesh has texture coordinates for a map, or if the height map is invalid
void override_materials(Scene& scene, const ViewOptions& options, Stages& stages, Report& report,
                        std::vector<std::string>& notes);

/// The height map of the options.
SceneHeights scene_heights(const ViewOptions& options);

// The environment, and the composed scene.

void add_environment_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if an option needs another one
void check_environment(const ViewOptions& options);

/// The environment of the options.
/// \throws FileError if a folder does not have six images, or if the layout of an image is unclear
Environment environment_of(const ViewOptions& options);

/// Applies the reflection options to a material.
void set_reflection(Material& material, const ViewOptions& options);

/// A scene with its camera, ready to be drawn.
struct ComposedScene {
    SceneGraph graph;
    Camera camera;
    bool camera_follows_scene = false;  ///< The camera belongs to the scene and may move.
    std::vector<std::string> notes;     ///< Messages for the summary.

    // The transformations of all instances and the rotation center, for turntables.
    std::vector<glm::mat4> at_rest;
    glm::vec3 middle{0.0F};

    Scene& scene() { return graph.scene; }
    [[nodiscard]] const Scene& scene() const { return graph.scene; }
};

/// Reads the model and applies the options.
///
/// \param options  settled (view_options.h); without --size, the size becomes that of the scene
///                 file
/// \throws FileError if a file cannot be read, has no triangles, or lacks data that an option needs
/// \throws UsageError if an option would have no effect in this scene
ComposedScene compose_scene(ViewOptions& options, Stages& stages, Report& report);

/// Returns the number of triangles of all instances.
std::size_t triangle_count(const Scene& scene);

}  // namespace relief::tools
