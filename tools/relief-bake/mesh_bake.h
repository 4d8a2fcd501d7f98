// SPDX-License-Identifier: Apache-2.0
/// \file
/// A bake from files to files, and its summary. Tests: tests/tools/relief_bake_mesh_test.cpp,
/// relief_bake_accuracy_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

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

struct MeshBake {
    std::size_t high_triangles = 0;
    std::size_t low_triangles = 0;
    bool has_file_tangents = false;
    std::size_t materials = 0;    ///< Of the low mesh.
    std::vector<BakePair> pairs;  ///< As in BakeModels.
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

/// Reads models, bakes and writes. The stages are "read", "bake" (which also writes) and "verify".
/// No file is written before all maps are baked and none misses too many texels.
/// \throws FileError, UsageError
MeshBake bake_maps(const MeshBakeRequest& request, Stages& stages);

Summary summary_of(const MeshBakeRequest& request, const MeshBake& bake, const Stages& stages);

/// A warning if several materials share texels of one map; else empty.
std::string shared_texels_warning(const MeshBakeRequest& request, const MeshBake& bake);

}  // namespace relief::tools
