// SPDX-License-Identifier: Apache-2.0
/// \file
/// Decimates a mesh to a number of triangles.
#pragma once

#include <cstddef>

#include "relief/mesh/frames.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"

namespace relief::test {

inline Mesh decimated_to(const Mesh& mesh, std::size_t triangles, Report& report,
                         NormalMode normals = NormalMode::keep) {
    return decimated(mesh, {triangles, {}, {.normals = normals}}, report).mesh;
}

}  // namespace relief::test
