// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tangent frames of somebody's mesh: bases, and their storage. Tests:
/// tests/accuracy/own_mesh_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/accuracy/own.h"

namespace relief {

/// \param mesh   with texture coordinates; where it has no normals, it gets averaged ones
/// \param whole  as for own_normals()
std::vector<OwnExperiment> own_tangents(Mesh mesh, const std::string& whole,
                                        const OwnOptions& options);

}  // namespace relief
