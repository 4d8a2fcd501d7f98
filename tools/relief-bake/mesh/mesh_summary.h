// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake mesh` says it did: for people, or as the --report file.
/// Tests: tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "mesh/mesh_job.h"

namespace relief::tools {

void print_summary(const MeshBakeRequest& request, const MeshBake& baked, const Stages& stages);

/// What to do where several materials share a map and texels of it; empty where they do not.
std::string remedy_for_shared_texels(const MeshBakeRequest& request, const MeshBake& baked);

nlohmann::ordered_json results_json(const MeshBakeRequest& request, const MeshBake& baked,
                                    const Stages& stages);

}  // namespace relief::tools
