// SPDX-License-Identifier: Apache-2.0
/// \file
/// The errors of a bake: samples and bits are selected by measured errors, and finished maps are
/// compared with their models.
/// Tests: tests/tools/relief_bake_accuracy_test.cpp, relief_bake_check_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/normal_map_input.h"
#include "mesh_models.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"

namespace relief::tools {

// Samples and bits by measured errors.

/// The measured error of one method, on a part of the map.
struct MeasuredBake {
    SampleChoice samples;
    std::optional<double> sample_angle;  ///< In degrees, with `auto`.
    NormalMapFormat format;
    ErrorStats error;
    ErrorStats rounding;  ///< The error of the format alone.
    ErrorStats sampling;  ///< The error of the samples alone.
    std::size_t rays = 0;
    double seconds = 0.0;  ///< Of the rays; with --compare the median, including the encoding.
    bool is_pareto_optimal =
        false;  ///< With --compare: no other method is faster and more accurate.
};

/// "4 samples, 16 bit", "auto samples at 2 degrees, 8 bit, dithered"
std::string to_string(const MeasuredBake& bake);

struct MeshAccuracy {
    /// --max-error: in the order tried, up to the selected one. --compare: all.
    std::vector<MeasuredBake> measured;
    std::optional<MeasuredBake> selected;  ///< With --max-error.
    std::size_t texels = 0;                ///< Of the measured part.
    bool is_whole = true;
    int reference_samples = 0;
    std::size_t reference_rays = 0;
};

/// \throws UsageError if options contradict each other, or have no effect
void check_accuracy(const MeshBakeRequest& request);

/// Measures errors; with --max-error also sets the samples of the request and the format.
///
/// Samples increase from 1 to 256, unless they are given. For each count, all bit depths of the
/// file format are measured, which costs no rays. The first count with a depth within the limit is
/// selected, with the smallest such depth. 256 samples are compared with a reference of 1024, on an
/// eighth of the texels; if the map is too large for that, the maximum is 64.
/// \throws InvalidInput if no method is within the limit, with the smallest error, its larger part,
///         and the depth that another file format would need
MeshAccuracy select_accuracy(const Baker& baker, const BakeMapOptions& map,
                             MeshBakeRequest& request, NormalMapFormat& format);

// Verification: a finished map is compared with its models.

struct VerifyRequest {
    std::filesystem::path map;
    MapInputOptions input{};
    ErrorBound bound{};
    std::optional<std::filesystem::path> error_map;
};

struct VerifiedMap {
    BakeCheck check;
    VerifyRequest request;
    double brightest = 0.0;  ///< The error of the brightest color of the error map, in degrees.
    std::vector<std::string> problems;
    std::vector<std::string> remedies;  ///< Commands.
    double milliseconds = 0.0;
};

/// \param models  with the low mesh as it was read
/// \param map     the options of the map; the size is that of the file
/// \throws FileError if the map cannot be read, or the error map cannot be written
VerifiedMap verify_map(const Baker& baker, const BakeModels& models, const MeshBakeRequest& bake,
                       BakeMapOptions map, const VerifyRequest& request, Report& report);

/// "RMS 0.131 degrees, mean 0.12, 99 of 100 within 0.3, 2.1 at most"
std::string to_string(const ErrorStats& summary);

void print_verified(const VerifiedMap& map);
nlohmann::ordered_json verified_json(const VerifiedMap& map);

}  // namespace relief::tools
