// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options of `relief-bake mesh`. `relief-bake check --high` shares those of models, rays and
/// texels. Tests: tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "common/error_bound.h"
#include "common/material_maps.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"

namespace relief::tools {

enum class Background { flat, transparent };

/// The samples of a texel.
struct SampleChoice {
    int count = 1;
    bool is_auto = false;
    bool is_given = false;
};

/// A file for all high models, or an empty path for none. Absent: those of their materials.
struct HighTextureOptions {
    std::optional<std::filesystem::path> normal_map, color;
    AssumedKinds assumed;
};

/// The layers that are written beside the normal map.
struct LayerOptions {
    std::map<LayerKind, std::filesystem::path> files;
    std::optional<int> bits;
    std::optional<double> height_range, curvature_range, position_range;
    std::optional<int> occlusion_rays;  ///< Also of bent normals.
    std::optional<double> occlusion_distance;
    std::optional<int> thickness_rays;
    std::optional<double> thickness_distance;

    [[nodiscard]] bool has(LayerKind kind) const { return files.contains(kind); }
};

/// The bit depth of a layer: 8, 16, or 32 for floats.
/// \throws UsageError if the file format cannot store it
int bits_of(const LayerOptions& options, LayerKind kind);

struct PreviewOptions {
    std::optional<std::filesystem::path> file;
    std::optional<glm::ivec2> size;  ///< Of each panel.
};

struct MeshBakeRequest {
    std::vector<std::filesystem::path> high;
    std::filesystem::path low, output;
    std::optional<std::filesystem::path> cage;
    glm::ivec2 size{1024, 1024};
    std::optional<RayDirections> directions;
    std::optional<double> hardness;
    /// Other options of the library: space, ray lengths, back faces, padding, size mismatch,
    /// repeating texture coordinates.
    BakeOptions bake = default_bake();
    std::optional<double> max_missed;  ///< In percent of the covered texels.
    PartMatching match = PartMatching::automatic;
    SampleChoice samples;
    std::optional<double> sample_angle;  ///< In degrees.
    bool fills_to_border = false;        ///< Instead of the padding.
    Background background = Background::flat;
    MapOutputOptions map;
    LayerOptions layers;
    HighTextureOptions textures;
    PreviewOptions preview;
    WriteIntoOptions write_into;
    ReportOptions report;
    bool verify = false;
    std::optional<std::filesystem::path> error_map;
    ErrorBound bound;
    bool compare = false;

    /// Returns whether errors are measured before the bake.
    [[nodiscard]] bool measures_errors() const { return compare || bound.degrees.has_value(); }

    /// The limit of missed texels in percent: --max-missed or its default.
    [[nodiscard]] double missed_limit() const { return max_missed.value_or(50.0); }

    static BakeOptions default_bake() {
        BakeOptions options;
        options.map.padding = 16;
        return options;
    }
};

/// The placeholder of material names in output files.
inline constexpr std::string_view material_word = "<material>";

void add_ray_options(CLI::App& app, MeshBakeRequest& request);

/// Adds --space, --samples, --sample-angle and --outside.
void add_texel_options(CLI::App& app, MeshBakeRequest& request);

/// Adds --max-missed and --allow-size-mismatch.
/// \param consequence  the result if more texels are missed, as a sentence
void add_fit_options(CLI::App& app, MeshBakeRequest& request, const std::string& consequence);

void add_high_normal_map_option(CLI::App& app, HighTextureOptions& options);

void add_error_map_option(CLI::App& app, std::optional<std::filesystem::path>& file);

/// \throws UsageError if options of rays and texels contradict each other, or have no effect
void check_bake_options(const MeshBakeRequest& request);

/// \param files  the other files of the command
/// \throws UsageError if the error map has another format or is one of these files; FileError if
///         its folder does not exist
void check_error_map(const std::optional<std::filesystem::path>& file,
                     const std::vector<std::filesystem::path>& files);

/// Checks the preview file in the same way.
void check(const PreviewOptions& options, const std::vector<std::filesystem::path>& files);

/// The angle between first samples, in degrees, above which --samples auto casts more; absent
/// unless `samples` is auto.
std::optional<double> angle_of(const MeshBakeRequest& request, const SampleChoice& samples);

/// The complete options of the library, except for the cage and what depends on the models.
BakeOptions bake_options_of(const MeshBakeRequest& request);

}  // namespace relief::tools
