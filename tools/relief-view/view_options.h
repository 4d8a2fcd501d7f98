// SPDX-License-Identifier: Apache-2.0
/// \file
/// What relief-view can be asked for, and which requests contradict each other or could show
/// nothing. Angles are radians here, degrees on the command line.
/// Tests: tests/tools/relief_view_test.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "common/options.h"
#include "light_option.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/context.h"
#include "relief/shade/scene.h"

namespace relief::tools {

/// From where the camera looks at the model.
struct CameraOption {
    float azimuth = 0;          ///< Radians from +z towards +x.
    float elevation = 0;        ///< Radians above the horizon.
    float distance_factor = 1;  ///< Of the distance from which all of the model is seen.
};

/// Everything on the command line. What was not given is absent.
struct ViewOptions {
    std::filesystem::path model;
    std::optional<std::filesystem::path> output;
    glm::ivec2 size{1024, 1024};
    int samples = 4;

    std::optional<std::filesystem::path> reference;
    std::optional<double> max_difference;  ///< From the reference; absent: 0.
    std::optional<std::filesystem::path> difference_map;

    std::optional<std::filesystem::path> normal_map;
    std::optional<float> normal_scale;
    std::optional<Green> green;
    std::optional<std::filesystem::path> height_map;
    std::optional<double> strength;
    std::optional<Kernel> kernel;
    std::optional<std::filesystem::path> diffuse_map;

    std::vector<std::filesystem::path> environment;  ///< A panorama, a folder, or six files.
    bool no_skybox = false;
    std::optional<float> reflectivity;
    std::optional<float> shininess;
    std::optional<SpecularModel> specular;

    std::vector<LightOption> lights;
    std::optional<float> ambient;
    std::optional<CameraOption> camera;
    std::optional<float> vertical_fov;
    std::optional<glm::vec4> background;  ///< Linear RGB and coverage.

    Backend backend = Backend::automatic;
    bool explain_effects = false;
    bool json = false;
    GeneralOptions general;
};

/// "azimuth,elevation[,factor]", in degrees. \throws UsageError
CameraOption parse_camera(const std::string& subject, const std::string& text);

void add_view_options(CLI::App& app, ViewOptions& options);

/// Settles what parsing left open and refuses what contradicts itself. \throws UsageError
void settle(ViewOptions& options);

/// Float radiance (.exr), not display colour (.png): as the output is, or else the reference.
bool is_linear_output(const ViewOptions& options);

}  // namespace relief::tools
