// SPDX-License-Identifier: Apache-2.0
/// \file
/// The textured meshes that tangents are measured on, by the experiments and by the tables of
/// docs/tangents.md. Tests: tests/accuracy/tangent_methods_test.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "relief/mesh/analytic_surfaces.h"

namespace relief {

struct TexturedCase {
    std::string id;    ///< "torus-jittered-mirrored"
    std::string name;  ///< "torus, jittered, image mirrored"
    bool has_cells = true;
    std::function<TexturedMesh(int cells)> mesh;
};

/// Every surface regular, jittered and anisotropic; the jittered torus with its image sheared and
/// mirrored; and a plate with thin bevels, which has no cells.
std::vector<TexturedCase> textured_cases();

}  // namespace relief
