// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake bump` can be asked for. Tests: tests/tools/relief_bake_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>

#include "common/options.h"
#include "map_output.h"
#include "relief/mesh/bump.h"

namespace relief::tools {

/// Absent: by what the map itself shows.
using WrapChoice = std::optional<Wrap>;

/// How to convert a height map; the same for every map of a call.
struct BumpRequest {
    BumpOptions bump;
    std::optional<double> strength;
    std::optional<double> height;
    std::optional<glm::dvec2> texel;
    std::optional<int> gaussian_radius;
    WrapChoice wrap_x = Wrap::repeat;
    WrapChoice wrap_y = Wrap::repeat;
    MapOutputOptions output;
};

/// All but how the map is written.
void add_bump_options(CLI::App& app, BumpRequest& request);

/// The options of the library, but for what the map decides.
/// \throws UsageError where some contradict each other
BumpOptions bump_of(const BumpRequest& request);

}  // namespace relief::tools
