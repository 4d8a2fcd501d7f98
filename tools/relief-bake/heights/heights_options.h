// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake heights` can be asked for. Tests: tests/tools/relief_bake_heights_test.cpp.
#pragma once

#include <filesystem>
#include <optional>

#include "common/choices.h"
#include "common/command.h"
#include "common/normal_map_input.h"
#include "relief/mesh/heights_from_normals.h"

namespace relief::tools {

/// How to make heights of a normal map; the same for every map of a call.
struct HeightsRequest {
    MapInputOptions input;
    IntegrationOptions integration;  ///< But for the wraps.
    WrapsOrAuto wrap{};
    std::optional<int> bits{};
};

void add_heights_options(CLI::App& app, HeightsRequest& request);

/// The depth to write. \throws UsageError if the format cannot hold heights, or not in that depth
int bits_of(const HeightsRequest& request, const std::filesystem::path& output);

}  // namespace relief::tools
