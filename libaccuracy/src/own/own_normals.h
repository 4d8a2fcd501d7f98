// SPDX-License-Identifier: Apache-2.0
/// \file
/// Averaged normals of somebody's mesh, from a surface fitted through it or from its own.
/// Tests: tests/accuracy/own_mesh_test.cpp.
#pragma once

#include "relief/accuracy/own.h"

namespace relief {

/// \param whole  how the mesh came to be measured, after a comma: "; 1048576 of 3000000 triangles"
OwnExperiment own_normals(const Mesh& mesh, const std::string& whole,
                          const OwnMeshOptions& mesh_options, const OwnOptions& options);

}  // namespace relief
