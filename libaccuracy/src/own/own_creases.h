// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which edges of somebody's mesh are hard. Tests: tests/accuracy/own_mesh_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"

namespace relief {

/// Their rule; the mesh must outlive it.
struct OwnCreases {
    HardEdges edges;
    std::string words;   ///< "edges sharper than 40 degrees are hard"
    std::string option;  ///< Of relief-mesh process, with a space before: " --crease 40".

    [[nodiscard]] bool has_any() const {
        return edges.crease_angle.has_value() || !edges.smoothing_groups.empty();
    }
};

/// \param told  the angle asked for, radians; pi: none is hard
///
/// Unless told: by smoothing groups, where the mesh has some that are not 0; else by the angle that
/// parts the edges where its own normals break from the others. Below 15 degrees that says that
/// the mesh is stored as facets, and nothing about edges.
OwnCreases own_creases(const Mesh& mesh, const std::optional<double>& told);

}  // namespace relief
