// SPDX-License-Identifier: Apache-2.0
/// \file
/// `relief-bake convert`: the request, the conversion of one normal map, and its summary.
/// Tests: tests/tools/relief_bake_convert_test.cpp.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "common/normal_map_input.h"
#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"

namespace relief::tools {

/// A size in texels, or as a fraction of the size of the map.
struct SizeChoice {
    glm::ivec2 texels{0, 0};
    double fraction = 0.0;  ///< If positive, it replaces `texels`.
};

enum class Flip { green, red, both };

enum class AlphaChoice { keep, drop };

struct DetailOptions {
    std::optional<std::filesystem::path> file;
    NormalBlend blend = NormalBlend::reoriented;
    std::optional<double> strength;
    std::optional<glm::dvec2> repeat;
    MapInputOptions input;
};

struct ResizeChoice {
    std::optional<SizeChoice> size;
    ResizeOptions options;
};

/// The mesh of a conversion between tangent space and object space.
struct SpaceOptions {
    std::optional<std::filesystem::path> to_object;
    std::optional<std::filesystem::path> to_tangent;
    std::optional<TangentMethod> tangents;
    std::optional<bool> repeats;  ///< Texture coordinates outside of the unit square.
    std::optional<int> udim;      ///< From 1001.
};

struct MipOptions {
    bool wanted = false;
    bool lengths = false;             ///< Stored in alpha.
    std::optional<double> roughness;  ///< Of the surface.
};

/// The options of a conversion, the same for every map of a call.
struct ConvertRequest {
    MapInputOptions input;
    std::optional<Flip> flip;
    std::optional<AxisMapping> axes;
    std::optional<XyChannels> rebuild_z;
    bool normalize = false;
    ResizeChoice resize;
    std::optional<double> strength;
    DetailOptions detail;
    SpaceOptions space;
    MipOptions mips;
    AlphaChoice alpha = AlphaChoice::keep;
    MapOutputOptions output;
};

/// The names of choices, for options and summaries.
Choices<ResizeFilter> filter_choices();
Choices<ResizeDomain> domain_choices();
Choices<NormalBlend> blend_choices();

/// The smallest UDIM tile number.
inline constexpr int first_udim = 1001;

/// A written mip level; level 0 is the map itself.
struct WrittenLevel {
    std::filesystem::path file;
    int width = 0;
    int height = 0;
    double mean_length = 1.0;  ///< Of the averaged vectors: 1 if all normals agree.
    double min_length = 1.0;
    std::optional<std::filesystem::path> roughness_file;
    std::optional<double> mean_roughness;
};

/// The result of a conversion.
struct MapConversion {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits_read = 0;
    std::string input_text;              ///< The conventions of the input.
    std::vector<std::string> steps;      ///< The operations, in order.
    std::optional<LengthRange> lengths;  ///< Of the input's vectors, if they were measured.
    NormalMapFormat format;
    std::optional<Green> green;          ///< Absent: unknown.
    std::optional<std::string> content;  ///< The new "relief:content", if it changes.
    std::vector<WrittenLevel> levels;
    Findings findings;
};

/// Converts a file. The stages are "read", "convert" and "write".
/// \throws FileError, UsageError
MapConversion convert_map(const Job& job, const ConvertRequest& request, Stages& stages);

/// All files that the output may consist of, with as many mip levels as the largest map has.
std::vector<std::filesystem::path> output_files(const std::filesystem::path& output,
                                                const MipOptions& mips);

}  // namespace relief::tools
