// SPDX-License-Identifier: Apache-2.0
/// \file
/// Detailed models and a simple one to a normal map, from files to file.
/// Tests: tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include "common/findings.h"
#include "mesh/mesh_options.h"

namespace relief::tools {

/// What was baked.
struct BakedMap {
    std::size_t high_triangles = 0;
    std::size_t low_triangles = 0;
    bool has_own_tangents = false;
    BakeResult result;
    NormalMapFormat format;
    Findings findings;
};

/// Reads, bakes and writes; the stages are "read" and "bake", which writes as well.
/// \throws FileError, UsageError
BakedMap bake_map(const MeshBakeRequest& request, Stages& stages);

}  // namespace relief::tools
