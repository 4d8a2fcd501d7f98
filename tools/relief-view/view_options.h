// SPDX-License-Identifier: Apache-2.0
/// \file
/// What relief-view can be asked for, and which requests contradict each other or could show
/// nothing. Angles are radians here, degrees on the command line.
/// Tests: tests/tools/relief_view_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "common/options.h"
#include "compare_choices.h"
#include "debug_choices.h"
#include "effect_choices.h"
#include "light_option.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/normal_map.h"
#include "relief/shade/context.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {

/// What the camera looks at, in world space, and from how far away.
struct CameraPlace {
    glm::vec3 target{0.0F};
    float distance = 1.0F;
};

/// From where the camera looks at the model.
struct CameraOption {
    float azimuth = 0;          ///< Radians from +z towards +x.
    float elevation = 0;        ///< Radians above the horizon.
    float distance_factor = 1;  ///< Of the distance from which all of the model is seen.
    std::optional<CameraPlace> place = std::nullopt;  ///< Else the model is framed.
};

/// What a height map becomes.
enum class HeightUse { normal_map, bump_map };

/// How one environment image is laid out.
enum class EnvironmentLayout {
    automatic,  ///< Told by its shape: 2:1 a panorama, 4:3 or 3:4 a cross, 1:1 a probe.
    panorama,
    cross,
    probe,
};

/// Metallic and roughness that all materials take on.
struct MetallicOption {
    float metallic = 0;
    float roughness = 1;
};

/// Everything on the command line. What was not given is absent.
struct ViewOptions {
    std::filesystem::path model;
    std::optional<std::filesystem::path> output;
    std::optional<std::filesystem::path> save_scene;
    std::optional<std::filesystem::path> save_model;
    glm::ivec2 size{1024, 1024};
    bool size_given = false;  ///< Else a scene file may say it.
    int samples = 4;
    std::optional<float> exposure;  ///< The factor, not the stops.
    std::optional<ToneMapping> tone_mapping;

    std::optional<std::filesystem::path> reference;
    std::optional<double> max_difference;  ///< From the reference; absent: 0.
    std::optional<std::filesystem::path> difference_map;

    std::optional<std::filesystem::path> normal_map;
    std::optional<float> normal_scale;
    std::optional<Green> green;
    std::optional<NormalSpace> normal_space;
    std::optional<TangentFrame> tangent_frame;
    std::optional<std::filesystem::path> height_map;
    std::optional<HeightUse> height_as;
    std::optional<double> strength;
    std::optional<Kernel> kernel;
    std::optional<std::filesystem::path> diffuse_map;
    std::optional<bool> specular_antialiasing;

    std::optional<SceneOptions::MaterialModel> shading;
    std::optional<Interpolation> interpolation;
    std::optional<std::string> material;  ///< A name of the classic table.
    std::optional<MetallicOption> metallic_roughness;
    std::optional<float> shininess;
    std::optional<SpecularModel> specular;

    std::vector<std::filesystem::path> environment;  ///< One image, a folder, or six files.
    std::optional<EnvironmentLayout> environment_layout;
    std::optional<bool> environment_light;  ///< Absent: where materials are metallic-roughness.
    std::optional<float> environment_intensity;
    bool left_handed_environment = false;
    bool no_skybox = false;
    std::optional<float> reflectivity;
    std::optional<float> reflection_roughness;
    std::optional<FresnelModel> fresnel;
    bool no_fresnel = false;
    std::optional<float> refractive_index;
    std::optional<float> transmission;

    std::vector<LightOption> lights;
    std::optional<float> ambient;
    std::optional<float> light_markers;  ///< Radius in units of the scene's size.
    std::optional<CameraOption> camera;
    std::optional<float> vertical_fov;
    std::optional<glm::vec4> background;  ///< Linear RGB and coverage.

    std::optional<int> turntable;  ///< Pictures of one turn.
    std::optional<int> frames;     ///< Pictures of the scene's animation.
    std::optional<double> seconds;
    std::optional<double> frames_per_second;
    std::optional<double> time;

    std::optional<std::filesystem::path> dump_state;  ///< Of the window, as JSON.
    std::optional<float> ui_scale;                    ///< Of the window's letters and panels.
    bool no_state = false;  ///< The window is not remembered, and comes as usual.
    bool list_bindings = false;

    /// Neither a picture nor words are asked for: a window it is.
    [[nodiscard]] bool wants_window() const {
        return !output && !save_scene && !save_model && !reference && !explain_effects &&
               !effects.print_shaders && !effects.measures();
    }

    Backend backend = Backend::automatic;
    bool explain_effects = false;
    EffectChoices effects;
    DebugChoices debug;
    CompareChoices compare;
    bool json = false;
    bool strict = false;
    GeneralOptions general;
};

/// "azimuth,elevation[,factor]" or "azimuth,elevation@x,y,z,distance", in degrees.
/// \throws UsageError
CameraOption parse_camera(const std::string& subject, const std::string& text);

/// Degrees, 1 to 170, as radians. \throws UsageError
float parse_fov(const std::string& subject, const std::string& text);

void add_view_options(CLI::App& app, ViewOptions& options);

/// Refuses an option that could show nothing, or that contradicts another.
/// \throws UsageError "OPTION: BECAUSE (REMEDY)" if useless
void refuse(bool useless, const std::string& option, const std::string& because,
            const std::string& remedy);

/// Settles what parsing left open and refuses what contradicts itself. \throws UsageError
void settle(ViewOptions& options);

/// Float radiance (.exr), not display colour (.png): as the output is, or else the reference.
bool is_linear_output(const ViewOptions& options);

}  // namespace relief::tools
