// SPDX-License-Identifier: Apache-2.0
/// \file
/// Detailed models and a simple one to normal maps, from files to files.
/// Tests: tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include "common/findings.h"
#include "mesh/bake_models.h"
#include "mesh/mesh_accuracy.h"
#include "mesh/mesh_layers.h"
#include "mesh/mesh_options.h"
#include "mesh/mesh_sets.h"
#include "mesh/mesh_verify.h"

namespace relief::tools {

/// One map of a bake.
struct BakedMap {
    MapPlan plan;
    BakeResult result;
    std::optional<VerifiedMap> verified;  ///< Where that is asked for.
    std::vector<WrittenLayer> layers;
};

/// What was baked.
struct MeshBake {
    std::size_t high_triangles = 0;
    std::size_t low_triangles = 0;
    bool has_own_tangents = false;
    std::size_t materials = 0;    ///< Of the low mesh.
    std::vector<BakePair> pairs;  ///< As in BakeModels.
    std::vector<std::string> unpaired;
    NormalMapFormat format;
    std::string looks;        ///< HighLooks::words()
    double texel_size = 0.0;  ///< Of its maps, in the mean; where a height map is made.
    std::vector<BakedMap> maps;
    BakeResult all;                        ///< Sums over all maps, and the least and greatest.
    BakeFit fit;                           ///< Baker::fit()
    glm::dvec3 origin{0.0};                ///< As in BakeModels.
    std::optional<MeshAccuracy> accuracy;  ///< Where something was measured first.
    Findings findings;
};

/// Reads, bakes and writes; the stages are "read", "bake", which writes as well, and
/// "verify". No file is written before all maps are baked and none misses too many texels.
/// \throws FileError, UsageError
MeshBake bake_maps(const MeshBakeRequest& request, Stages& stages);

}  // namespace relief::tools
