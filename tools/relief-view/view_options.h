// SPDX-License-Identifier: Apache-2.0
/// \file
/// The values of the options of relief-view. Angles are radians here and degrees on the command
/// line. command_line.h adds all options.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/map_kind.h"
#include "common/options.h"
#include "field_options.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/mistakes.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_file.h"
#include "relief/shade/scene_variant.h"

namespace relief::tools {

struct Exercise;

/// "none": the scene has no lights.
struct NoLight {};

using LightOption =
    std::variant<NoLight, shade::DirectionalLight, shade::PointLight, shade::SpotLight>;

using Variant = shade::SceneVariant;

inline constexpr float default_split = 0.5F;

/// The options --compare, --compare-to and --split.
struct CompareChoices {
    std::optional<Variant> variant;
    std::optional<std::filesystem::path> file;  ///< Another model or scene.
    std::optional<float> split;                 ///< The position of the split, from 0 to 1.

    [[nodiscard]] bool compares() const { return variant || file; }
};

/// The findings of the health check that are marked.
enum class HealthChoice { problem, all };

/// The options --show, --wireframe, --vertex-frames, --frame-length, --grid and --health-markers.
struct DebugChoices {
    shade::DebugView view = shade::DebugView::picture;
    bool wireframe = false;
    bool vertex_frames = false;
    std::optional<float> frame_length;  ///< Relative to the size of the scene.
    bool grid = false;
    std::optional<HealthChoice> health_markers;
};

/// The options --effects, --benchmark, --budget and --print-shaders.
struct EffectChoices {
    shade::EffectRequest requests;  ///< --effects
    std::optional<int> benchmark;   ///< Number of frames to time.
    std::optional<double> budget;   ///< Maximum milliseconds per frame.
    bool print_shaders = false;

    /// Returns whether frames are drawn even without a picture.
    [[nodiscard]] bool measures() const { return benchmark || budget; }
};

/// The target of the camera in world space, and its distance.
struct CameraPlace {
    glm::vec3 target{0.0F};
    float distance = 1.0F;
};

/// The direction and distance of the camera.
struct CameraOption {
    float azimuth = 0;          ///< Radians from +z towards +x.
    float elevation = 0;        ///< Radians above the horizon.
    float distance_factor = 1;  ///< Relative to the distance that shows the whole model.
    std::optional<CameraPlace> place = std::nullopt;  ///< If absent, the model is framed.
};

/// The use of a height map.
enum class HeightUse { normal_map, bump_map };

/// The layout of an environment image.
enum class EnvironmentLayout {
    automatic,  ///< By aspect ratio: 2:1 panorama, 4:3 or 3:4 cross, 1:1 probe.
    panorama,
    cross,
    probe,
};

/// The values of --metallic-roughness.
struct MetallicOption {
    float metallic = 0;
    float roughness = 1;
};

/// All options of the command line. Options that were not given are empty.
struct ViewOptions {
    std::filesystem::path model;
    std::optional<std::filesystem::path> output;
    std::optional<std::filesystem::path> save_scene;
    std::optional<std::filesystem::path> save_model;
    glm::ivec2 size{1024, 1024};
    bool size_given = false;  ///< Otherwise a scene file may set the size.
    int samples = 4;

    // Fields of all materials, of the environment and of the scene.
    FieldChanges<Material> material_fields;
    FieldChanges<shade::Environment> environment_fields;
    FieldChanges<shade::Scene> scene_fields;
    bool no_fresnel = false;  ///< --fresnel none

    std::optional<std::filesystem::path> exercise_file;
    std::shared_ptr<const Exercise> exercise;  ///< That of the file; its scene is the model.
    bool steps = false;
    std::vector<const shade::Mistake*> mistakes;  ///< --mistake
    bool all_mistakes = false;                    ///< Those of them that show.

    std::optional<std::filesystem::path> reference;
    std::optional<double> max_difference;  ///< From the reference. If absent, it is 0.
    std::optional<std::filesystem::path> difference_map;

    std::optional<std::filesystem::path> normal_map;
    std::optional<float> normal_scale;
    AssumedKinds assumed;
    std::optional<Green> green;
    std::optional<NormalSpace> normal_space;
    std::optional<std::filesystem::path> height_map;
    std::optional<HeightUse> height_as;
    std::optional<double> strength;
    std::optional<Kernel> kernel;
    FieldChanges<ReliefMap> relief_fields;  ///< Of all height maps that displace; add them, too.
    std::optional<std::filesystem::path> cone_map;
    std::optional<std::filesystem::path> diffuse_map;

    std::optional<NormalMode> normals;
    std::optional<double> crease_degrees;
    std::optional<shade::UpAxis> up;
    std::optional<std::string> material_variant;  ///< Its name or number in a glTF file.

    std::optional<shade::SceneOptions::MaterialModel> shading;
    std::optional<std::string> material;  ///< A name of the table of classic materials.
    std::optional<MetallicOption> metallic_roughness;

    /// One image, one folder, six files, "studio" or "none".
    std::vector<std::filesystem::path> environment;
    std::optional<EnvironmentLayout> environment_layout;
    bool left_handed_environment = false;

    std::vector<LightOption> lights;
    std::optional<float> light_markers;  ///< Radius relative to the size of the scene.
    std::optional<CameraOption> camera;
    std::optional<float> vertical_fov;
    bool orthographic = false;
    std::optional<std::string> model_camera;  ///< The name or number of a camera of the file.

    std::optional<int> turntable;  ///< Pictures per turn.
    std::optional<int> frames;     ///< Pictures of the animation.
    std::optional<double> seconds;
    std::optional<double> frames_per_second;
    std::optional<double> time;
    std::optional<std::string> animation;  ///< The name or number of a clip, or "all".

    std::optional<std::filesystem::path> dump_state;  ///< JSON file for the state of the window.
    std::optional<float> ui_scale;                    ///< Scale of the user interface.
    bool no_state = false;  ///< The layout of the window is neither read nor written.
    bool list_bindings = false;
    std::optional<glm::ivec2> probe;  ///< The pixel to explain: column and row.

    /// True if no option asks for output.
    [[nodiscard]] bool wants_window() const {
        return !output && !save_scene && !save_model && !reference && !explain_effects && !probe &&
               mistakes.empty() && !effects.print_shaders && !effects.measures();
    }

    shade::Backend backend = shade::Backend::automatic;
    bool explain_effects = false;
    EffectChoices effects;
    DebugChoices debug;
    std::vector<shade::DebugView> page_views;  ///< --page-views
    bool page_quantize = false;                ///< --page-quantize
    glm::ivec2 page_probes{0};                 ///< --page-probes: columns and rows of pixels.
    CompareChoices compare;
    bool json = false;
    bool strict = false;
    GeneralOptions general;
};

/// Rejects an option without effect or with a contradiction.
/// \throws UsageError "OPTION: PROBLEM (REMEDY)" if useless
void refuse(bool useless, const std::string& option, const std::string& because,
            const std::string& remedy);

/// Returns whether the options ask for several pictures.
bool is_sequence(const ViewOptions& options);

/// The number of pictures; 1 without a sequence.
int picture_count(const ViewOptions& options);

/// Returns whether the model is a scene file (.json).
bool is_scene_file(const ViewOptions& options);

/// Returns whether the output, or else the reference, stores linear radiance (.exr, .hdr).
bool is_linear_output(const ViewOptions& options);

}  // namespace relief::tools
