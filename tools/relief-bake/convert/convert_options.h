// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake convert` can be asked for. Tests: tests/tools/convert_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>

#include "common/command.h"
#include "common/normal_map_input.h"
#include "convert/convert_space.h"
#include "map_output.h"
#include "relief/mesh/normal_blend.h"
#include "relief/mesh/normal_map_operations.h"
#include "relief/mesh/normal_resize.h"

namespace relief::tools {

/// A size in texels, or as a share of the map's own.
struct SizeChoice {
    glm::ivec2 texels{0, 0};
    double share = 0.0;  ///< Above 0 where it says the size.
};

/// --flip
enum class Flip { green, red, both };

/// --alpha
enum class AlphaChoice { keep, drop };

struct DetailChoice {
    std::optional<std::filesystem::path> file;
    std::optional<NormalBlend> blend;
    std::optional<double> strength;
    std::optional<glm::dvec2> repeat;
    MapInputOptions input;
};

struct ResizeChoice {
    std::optional<SizeChoice> size;
    std::optional<ResizeFilter> filter;
    std::optional<ResizeDomain> domain;
    std::optional<Wraps> wrap;
};

struct MipChoice {
    bool wanted = false;
    bool lengths = false;             ///< In alpha.
    std::optional<double> roughness;  ///< Of the map itself.
};

/// How to convert a map; the same for every map of a call.
struct ConvertRequest {
    MapInputOptions input;
    std::optional<Flip> flip;
    std::optional<AxisMapping> axes;
    std::optional<XyChannels> rebuild_z;
    bool normalize = false;
    ResizeChoice resize;
    std::optional<double> strength;
    DetailChoice detail;
    SpaceConversion space;
    MipChoice mips;
    AlphaChoice alpha = AlphaChoice::keep;
    MapOutputOptions output;
};

/// All but how the map is written.
void add_convert_options(CLI::App& app, ConvertRequest& request);

/// \throws UsageError where options contradict each other, or one has no effect without another
void check_convert_options(const ConvertRequest& request);

/// What --flip and --axes make of the stored vectors.
AxisMapping mapping_of(const ConvertRequest& request);

}  // namespace relief::tools
