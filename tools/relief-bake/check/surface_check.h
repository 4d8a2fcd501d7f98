// SPDX-License-Identifier: Apache-2.0
/// \file
/// `relief-bake check MAP --high HIGH --low LOW`: a map held against the models it is for, by the
/// rays that it was baked with, as its file says or the command line.
/// Tests: tests/tools/relief_bake_verify_test.cpp.
#pragma once

#include <optional>

#include "mesh/bake_words.h"
#include "mesh/mesh_verify.h"

namespace relief::tools {

struct SurfaceCheckRequest {
    MeshBakeRequest bake;  ///< Models, rays and texels as told.
    VerifyRequest verify;
    std::optional<int> udim;
};

/// --high, --low, those of rays and texels, --udim, --max-error, --error-map.
void add_surface_check_options(CLI::App& app, SurfaceCheckRequest& request);

/// Whether a map is to be held against models.
bool is_wanted(const SurfaceCheckRequest& request);

/// \param maps  on the command line
/// \throws UsageError if options have no effect, models are missing, or there are several maps
void check(const CLI::App& app, const SurfaceCheckRequest& request,
           const std::vector<std::filesystem::path>& maps);

/// A map held against its models.
struct SurfaceCheck {
    BakeWords of_file;  ///< How it was baked, as its file says
    BakeWords used;     ///< and as was taken.
    BakeDistances distances;
    VerifiedMap map;
    Findings findings;
    [[nodiscard]] bool is_good() const { return map.trouble.empty(); }
};

/// Reads models and map. \throws FileError, UsageError
SurfaceCheck check_surface(const CLI::App& app, const SurfaceCheckRequest& request, Stages& stages);

void print_text(const SurfaceCheck& check);
nlohmann::ordered_json json_of(const SurfaceCheck& check);

}  // namespace relief::tools
