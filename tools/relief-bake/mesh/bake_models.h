// SPDX-License-Identifier: Apache-2.0
/// \file
/// The models of a bake, from files, all in the same axes. Tests:
/// tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/findings.h"
#include "mesh/mesh_options.h"
#include "relief/mesh/mesh.h"

namespace relief::tools {

struct BakeModels {
    std::vector<Mesh> high;
    Mesh low;
    std::vector<std::string> materials;  ///< Of the low mesh.
    std::optional<glm::dmat3> world_from_low;
    std::optional<Mesh> cage;
};

/// \throws FileError if one cannot be read, or the low one has no texture coordinates
BakeModels read_bake_models(const MeshBakeRequest& request, Findings& findings);

/// What turns normals into the axes that they are wanted in, from those of the models.
/// \throws FileError if the low model has no axes of its own, and is asked for them
glm::dmat3 output_axes(const MeshBakeRequest& request,
                       const std::optional<glm::dmat3>& world_from_low);

}  // namespace relief::tools
