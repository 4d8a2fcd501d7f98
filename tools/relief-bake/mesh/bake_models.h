// SPDX-License-Identifier: Apache-2.0
/// \file
/// The models of a bake, from files, all in the same axes. Tests:
/// tests/tools/relief_bake_mesh_test.cpp, model_pairs_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/findings.h"
#include "mesh/high_looks.h"
#include "mesh/mesh_options.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"

namespace relief::tools {

/// Parts of one name on both sides.
struct BakePair {
    std::string name;
    std::size_t first_high = 0;  ///< Among BakeModels::high, where they are side by side.
    std::size_t high_count = 0;
    std::size_t high_triangles = 0;
    std::vector<std::uint32_t> low;  ///< Triangles.
};

struct BakeModels {
    std::vector<Mesh> high;  ///< One for each file, or where there are pairs, for each part.
    Mesh low;
    std::vector<std::string> materials;  ///< Of the low mesh.
    std::optional<glm::dmat3> world_from_low;
    glm::dvec3 origin{0.0};  ///< In the world; positions are relative to it.
    std::optional<Mesh> cage;
    HighLooks looks;
    std::vector<BakePair> pairs;  ///< None: all is seen by all.
    /// Names without a counterpart, where that is why there are no pairs.
    std::vector<std::string> unpaired;

    /// Makes them ready, each low part for what it sees; they must outlive the baker.
    [[nodiscard]] Baker baker(const BakeOptions& options, Report& report) const;
};

/// \throws FileError if one cannot be read, or the low one has no texture coordinates
BakeModels read_bake_models(const MeshBakeRequest& request, Findings& findings);

/// What turns normals into the axes that they are wanted in, from those of the models.
/// \throws FileError if the low model has no axes of its own, and is asked for them
glm::dmat3 output_axes(const MeshBakeRequest& request,
                       const std::optional<glm::dmat3>& world_from_low);

}  // namespace relief::tools
