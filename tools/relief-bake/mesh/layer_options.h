// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake mesh` makes beside normals: a file for each layer that is asked for, and how
/// its numbers are stored. Tests: tests/tools/relief_bake_mesh_layers_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "map_output.h"
#include "relief/mesh/bake_layers.h"

namespace relief::tools {

enum class LayerKind { height, occlusion, curvature, position, color };

/// "height map", "ambient occlusion", ... for people and as "relief:content" in files.
std::string layer_name(LayerKind kind);

struct LayerOptions {
    std::map<LayerKind, std::filesystem::path> files;  ///< Those asked for.
    std::optional<int> bits;
    std::optional<double> height_range, curvature_range, position_range;
    std::optional<int> occlusion_rays;
    std::optional<double> occlusion_distance;
};

/// --height-map, --occlusion-map, --curvature-map, --position-map, --color-map, and theirs.
void add_layer_options(CLI::App& app, LayerOptions& options);

/// \throws UsageError if a format cannot hold a layer, or an option has no effect
void check_layer_options(const LayerOptions& options);

/// Those that are asked for, beside normals.
BakeLayers layers_of(const LayerOptions& options);

/// 8, 16, or 32 for floats.
int bits_of(const LayerOptions& options, LayerKind kind);

}  // namespace relief::tools
