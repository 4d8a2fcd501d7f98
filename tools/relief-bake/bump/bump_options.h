// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake bump` can be asked for. Tests: tests/tools/relief_bake_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>

#include "bump/bump_accuracy.h"
#include "common/choices.h"
#include "common/options.h"
#include "map_output.h"
#include "relief/mesh/bump_file.h"

namespace relief::tools {

/// How to convert a height map; the same for every map of a call.
struct BumpRequest {
    std::optional<HeightChannel> channel;  ///< Absent: the mean, and a finding for colors.
    bool ignore_alpha = false;
    bool invert = false;
    BumpOptions bump;
    AccuracyRequest accuracy;
    std::optional<double> strength;
    std::optional<double> height;
    std::optional<glm::dvec2> texel;
    std::optional<int> gaussian_radius;
    WrapsOrAuto wrap;
    bool slope_moments = false;
    bool xy_only = false;
    MapAlpha alpha = MapAlpha::none;
    MapOutputOptions output;
};

/// All but how the map is written: --channel, --strength, --kernel, ...
void add_bump_options(CLI::App& app, BumpRequest& request);

/// What is written beside or instead of normals: --xy, --alpha, --slope-moments.
void add_bump_content_options(CLI::App& app, BumpRequest& request);

/// The options of the library, but for what the map decides.
/// \throws UsageError where some contradict each other
BumpOptions bump_of(const BumpRequest& request);

/// What to write to a file.
/// \throws UsageError if it cannot hold that, or some options contradict each other
BumpFileFormat file_format_of(const BumpRequest& request, const std::filesystem::path& output);

}  // namespace relief::tools
