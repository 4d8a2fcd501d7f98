// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bake from files to files, and its summary. Tests: tests/tools/relief_bake_mesh_test.cpp,
/// relief_bake_accuracy_test.cpp.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/material_maps.h"
#include "common/summary.h"
#include "mesh_accuracy.h"
#include "mesh_maps.h"
#include "mesh_models.h"

namespace relief::tools {

/// "2.5 million rays per second, 12 s left". The remaining time is shown after a second.
/// \param part  the finished part of all maps, 0 to 1
std::string progress_text(double part, double seconds, std::size_t rays);

struct BakedMap {
    MapPlan plan;
    BakeResult result;
    std::optional<VerifiedMap> verified;
    std::vector<WrittenLayer> layers;
};

/// The size of a BakePair.
struct PairCount {
    std::string name;
    std::size_t high_triangles = 0;
    std::size_t low_triangles = 0;
};

struct MeshBake {
    std::size_t high_triangles = 0;
    std::size_t low_triangles = 0;
    bool has_file_tangents = false;
    std::size_t materials = 0;  ///< Of the low mesh.
    std::vector<PairCount> pairs;
    std::vector<std::string> unpaired;
    NormalMapFormat format;
    std::string textures;             ///< HighTextures::description()
    std::optional<BakedAlpha> alpha;  ///< HighTextures::alpha()
    double texel_size = 0.0;  ///< The mean side of a texel in the unit of the mesh; 0: unknown.
    std::vector<BakedMap> maps;
    BakeResult all;                                    ///< Sums and extremes over all maps.
    BakeFit fit;                                       ///< Baker::fit()
    BakeAgreement agreement;                           ///< Baker::agreement()
    glm::dvec3 origin{0.0};                            ///< As in BakeModels.
    std::optional<accuracy::BakeComparison> accuracy;  ///< If errors were measured before the bake.
    std::optional<MaterialResult> stored;              ///< The materials of --write-into.
    Findings findings;
};

// The steps of a bake, for shards too.

/// Everything that is known before the first ray of a map.
struct PreparedBake {
    MapPlans plans;
    BakeOptions options;
    std::optional<Baker> baker;
    std::optional<MaterialRequest> materials;  ///< Of --write-into.
    BakeFacts facts;
};

/// Plans the maps and makes the baker, which refers to the models.
/// \param estimates_missed  whether to check_missed_early()
/// \throws FileError, UsageError
PreparedBake prepare_bake(const MeshBakeRequest& request, const BakeModels& models, Stages& stages,
                          MeshBake& bake, bool estimates_missed = true);

/// Checks that no planned map is the report, the preview or one of the other files.
/// \throws UsageError
void check_outputs(const MeshBakeRequest& request, const std::vector<MapPlan>& plans,
                   const std::vector<std::filesystem::path>& files);

/// Adds what is known from the models.
void describe_models(const MeshBakeRequest& request, const BakeModels& models, MeshBake& bake);

/// The request to store maps in the model of --write-into, which is made from the low model if it
/// does not exist.
MaterialRequest material_request(const MeshBakeRequest& request, const std::vector<MapPlan>& plans,
                                 const std::optional<BakedAlpha>& alpha);

/// Stores the maps in the model of --write-into.
void write_into(const MaterialRequest& request, Stages& stages, MeshBake& bake);

/// Bakes a map, or merges it. \param index  of the map
using MapSource = std::function<BakeResult(std::size_t index, const BakeMapOptions& map,
                                           const std::function<void(const BakedRows& rows)>& take,
                                           Report& report)>;

/// Writes all maps, and then renames the finished files.
/// \param uncovered  the error if no texel of any map is covered
/// \throws FileError if too many texels are missed, or none is covered
void write_maps(const MeshBakeRequest& request, const BakeFacts& facts, std::vector<MapPlan> plans,
                const BakeOptions& options, const MapSource& source,
                const std::function<FileError()>& uncovered, MeshBake& bake);

/// Reads models, bakes and writes. The stages are "read", "bake" (which also writes) and "verify".
/// No file is written before all maps are baked and none misses too many texels.
/// \throws FileError, UsageError
MeshBake bake_maps(const MeshBakeRequest& request, Stages& stages);

Summary summary_of(const MeshBakeRequest& request, const MeshBake& bake, const Stages& stages);

/// The findings for which --strict exits with 3: all except intended ones and those that an option
/// limits.
Findings strict_findings(const MeshBakeRequest& request, const Findings& findings);

/// A warning if several materials share texels of one map; else empty.
std::string shared_texels_warning(const MeshBakeRequest& request, const MeshBake& bake);

}  // namespace relief::tools
