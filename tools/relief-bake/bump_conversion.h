// SPDX-License-Identifier: Apache-2.0
/// \file
/// Converts one height map file, and describes the result: the work of `relief-bake bump`.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "commands.h"
#include "common/error_bound.h"
#include "common/map_kind.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/height_map.h"

namespace relief::tools {

/// The options of accuracy. Absent: chosen from the map itself.
struct BumpAccuracyRequest {
    std::optional<Kernel> kernel;
    std::optional<Arithmetic> precision;
    bool destaircase = false;
    Grain grain = Grain::automatic;
    ErrorBound bound;                       ///< Of the map and the conversion together.
    std::optional<double> max_added_error;  ///< Of the conversion alone, in the same statistic.
    bool compare = false;

    [[nodiscard]] bool has_limit() const { return bound.degrees || max_added_error; }
    [[nodiscard]] bool needs_experiment() const { return compare || has_limit(); }
};

/// The options of a conversion, the same for every map of a call.
struct BumpRequest {
    std::optional<HeightChannel> channel;  ///< Absent: the mean, with a finding for color images.
    bool ignore_alpha = false;
    bool invert = false;
    BumpAccuracyRequest accuracy;
    std::optional<double> strength;
    std::optional<double> height;
    std::optional<glm::dvec2> texel;
    std::optional<int> gaussian_radius;
    WrapsOrAuto wrap;
    bool slope_moments = false;
    bool xy_only = false;
    MapAlpha alpha = MapAlpha::none;
    std::optional<std::filesystem::path> cone_map;  ///< For relief mapping with relaxed cones.
    MapOutputOptions output;
    AssumedKinds assumed;
};

/// The choices that were made from the map, and the measured errors.
struct BumpAccuracy {
    std::optional<KernelChoice> choice;                  ///< With --kernel auto.
    std::optional<accuracy::BumpExperiment> experiment;  ///< With --compare and --max-error.
    std::optional<accuracy::BumpMeasurement> selected;   ///< The method within --max-error.
    double step = 0.0;  ///< Of the steps that were smoothed; 0: none.
};

/// The result of a conversion.
struct BumpConversion {
    ImageInfo input;
    bool is_streamed = false;     ///< A large map is read row by row.
    std::size_t transparent = 0;  ///< Texels that are not part of the surface.
    BumpOptions bump;             ///< With the choices that were made from the map.
    std::optional<Tiling> tiling;
    BumpAccuracy accuracy;
    BumpFileFormat format;
    Findings findings;
};

/// Returns the library's options, except for those that are chosen from the map.
/// \throws UsageError if options contradict each other
BumpOptions bump_options_of(const BumpRequest& request);

/// Returns the content and the format of the output file.
/// \throws UsageError if the file cannot store them, or options contradict each other
BumpFileFormat file_format_of(const BumpRequest& request, const std::filesystem::path& output);

/// Checks the file of a cone map and the options that would make it that of other heights.
/// \throws UsageError
void check_cone_map(const BumpRequest& request, const Job& job);

/// "gaussian 4", or the plain name of the kernel.
std::string kernel_name(const accuracy::BumpMethod& method);
/// "gaussian 4 in float32, 16 bit"
std::string method_text(const accuracy::BumpMethod& method);

/// Converts a file. The stages are "read", "look" and "choose" if something is chosen from the map,
/// "convert" and "write", and "cones" for a cone map.
/// \throws FileError, UsageError
BumpConversion convert_bump(const Job& job, const BumpRequest& request, Stages& stages);

Summary summary_of(const Job& job, const BumpRequest& request, const BumpConversion& conversion,
                   const Stages& stages);

/// The summary in one line, for a conversion of several files.
std::string line_of(const Job& job, const BumpConversion& conversion, const Stages& stages);

}  // namespace relief::tools
