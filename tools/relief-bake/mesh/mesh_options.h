// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake mesh` can be asked for. Tests: tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "common/command.h"
#include "common/findings.h"
#include "map_output.h"
#include "mesh/error_bound.h"
#include "mesh/high_looks.h"
#include "mesh/layer_options.h"
#include "mesh/model_pairs.h"
#include "mesh/preview_options.h"
#include "relief/mesh/bake.h"

namespace relief::tools {

/// --space
enum class SpaceChoice { tangent, object, world };

/// --background
enum class Background { flat, transparent };

/// --outside
enum class OutsideChoice { drop, repeat };

/// --samples
struct SampleChoice {
    int count = 1;
    bool is_auto = false;
    bool is_told = false;
};

/// --verify
struct VerifyChoice {
    bool wanted = false;
    std::optional<std::filesystem::path> error_map;
};

/// --max-error, --max-error-kind, --compare
struct AccuracyChoice {
    ErrorBound bound;
    bool compare = false;
};

struct MeshBakeRequest {
    std::vector<std::filesystem::path> high;
    std::filesystem::path low, output;
    std::optional<std::filesystem::path> cage;
    glm::ivec2 size{1024, 1024};
    SpaceChoice space = SpaceChoice::tangent;
    std::optional<RayDirections> directions;
    std::optional<double> hardness;
    std::optional<double> offset, max_distance;
    BackFaces back_faces = BackFaces::skip;
    bool allow_size_mismatch = false;
    std::optional<double> max_missed;  ///< Percent of the covered texels; see missed_limit().
    MatchChoice match = MatchChoice::automatic;
    OutsideChoice outside = OutsideChoice::drop;
    SampleChoice samples;
    std::optional<double> sample_angle;  ///< Degrees.
    int padding = 16;
    bool fills_to_border = false;  ///< Instead of `padding`.
    Background background = Background::flat;
    MapOutputOptions map;
    LayerOptions layers;
    HighLookOptions looks;
    PreviewOptions preview;
    ReportOptions report;
    VerifyChoice verify;
    AccuracyChoice accuracy;
};

/// How rays are cast; and what a texel is made of: --space, --samples, --sample-angle, --outside.
void add_ray_options(CLI::App& app, MeshBakeRequest& request);
void add_texel_options(CLI::App& app, MeshBakeRequest& request);

/// \param files  gets the file arguments, for check_mesh_options() to part
void add_mesh_options(CLI::App& app, MeshBakeRequest& request,
                      std::vector<std::filesystem::path>& files);

/// \throws UsageError where options of rays and texels contradict each other, or one has no effect
void check_bake_options(const MeshBakeRequest& request);

/// Parts the files into high meshes, low mesh and map.
/// \throws UsageError where options contradict each other, or one has no effect
void check_mesh_options(MeshBakeRequest& request, const std::vector<std::filesystem::path>& files);

/// By how many degrees first samples must differ for more; absent unless `samples` is auto.
std::optional<double> angle_of(const MeshBakeRequest& request, const SampleChoice& samples);

/// What the library is asked for; the cage is left out.
BakeOptions bake_options_of(const MeshBakeRequest& request);

}  // namespace relief::tools
