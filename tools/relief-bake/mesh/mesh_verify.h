// SPDX-License-Identifier: Apache-2.0
/// \file
/// A finished map held against the models that it was baked from: `relief-bake mesh --verify` and
/// `relief-bake check --high --low`. Tests: tests/tools/relief_bake_verify_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "common/findings.h"
#include "common/normal_map_input.h"
#include "mesh/bake_models.h"
#include "mesh/error_bound.h"
#include "relief/mesh/bake_check.h"

namespace relief::tools {

/// --max-error and --max-error-kind. \param description  what the bound is for
void add_bound_options(CLI::App& app, ErrorBound& bound, const std::string& description);

/// \throws UsageError if a kind is told of no bound
void check(const ErrorBound& bound);

/// "0.5 degrees (RMS)"
std::string bound_words(const ErrorBound& bound);

/// The error that a bound is for.
double bounded(const AngleSummary& summary, const ErrorBound& bound);

/// "RMS 0.131 degrees, mean 0.12, 99 of 100 within 0.3, 2.1 at most"
std::string error_words(const AngleSummary& summary);

/// What is to be checked, and how.
struct VerifyRequest {
    std::filesystem::path map;
    MapInputOptions input{};
    ErrorBound bound{};
    /// Where to show the errors: .png as colours, .exr and .tif in degrees.
    std::optional<std::filesystem::path> error_map;
};

/// --verify, --error-map, of the command that bakes.
void add_verify_options(CLI::App& app, VerifyChoice& choice);

/// --error-map
void add_error_map_option(CLI::App& app, std::optional<std::filesystem::path>& file);

/// \param files  what the command reads or writes otherwise
/// \throws UsageError if the file is of another format, or one of these; FileError if there is no
///         folder for it
void check_error_map(const std::optional<std::filesystem::path>& file,
                     const std::vector<std::filesystem::path>& files);

/// \throws UsageError where --verify and --error-map have no effect, or name files of others
void check_verify(const MeshBakeRequest& request, const std::vector<std::filesystem::path>& files);

struct VerifiedMap {
    BakeCheck check;
    VerifyRequest request;
    MapConvention told;
    double brightest = 0.0;             ///< Degrees that the error map shows brightest; 0: none.
    std::vector<std::string> trouble;   ///< In words.
    std::vector<std::string> remedies;  ///< As commands, where there are such.
    double milliseconds = 0.0;
};

/// \param models  the low one as given, for its own tangents and axes
/// \param map     as the map was made; the size is the file's
/// \throws FileError if the file cannot be read, or an error map not be written
VerifiedMap verify_map(const Baker& baker, const BakeModels& models, const MeshBakeRequest& bake,
                       BakeMapOptions map, const VerifyRequest& request, Report& report);

/// Lines for people.
void print_verified(const VerifiedMap& map);

nlohmann::ordered_json verified_json(const VerifiedMap& map);

}  // namespace relief::tools
