// SPDX-License-Identifier: Apache-2.0
/// \file
/// The errors of a bake: samples and bits are selected by measured errors, and finished maps are
/// compared with their models.
/// Tests: tests/tools/relief_bake_accuracy_test.cpp, relief_bake_check_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/normal_map_input.h"
#include "common/summary.h"
#include "mesh_models.h"
#include "relief/accuracy/bake_accuracy.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"

namespace relief::tools {

// Samples and bits by measured errors.

/// "4 samples, 16 bit", "auto samples at 2 degrees, 8 bit, dithered"
std::string to_string(const accuracy::MeasuredBake& bake);

/// \throws UsageError if options contradict each other, or have no effect
void check_accuracy(const MeshBakeRequest& request);

/// Measures errors as --compare or --max-error request. The latter sets the samples of the request
/// and the format.
/// \throws InvalidInput if no samples and bits are within the limit, with the smallest error, its
///         larger part, and the bits that another file format would need
accuracy::BakeComparison measure_errors(const Baker& baker, const BakeMapOptions& map,
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

/// "RMS 0.131 degrees, mean 0.12, 99 % within 0.3, 2.1 at most"
std::string to_string(const ErrorStats& summary);

Summary summary_of(const VerifiedMap& map);

}  // namespace relief::tools
