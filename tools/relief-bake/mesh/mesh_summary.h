// SPDX-License-Identifier: Apache-2.0
/// \file
/// What `relief-bake mesh` says it did: for people, or as the --report file.
/// Tests: tests/tools/relief_bake_mesh_test.cpp.
#pragma once

#include <nlohmann/json.hpp>

#include "mesh/mesh_job.h"

namespace relief::tools {

void print_summary(const MeshBakeRequest& request, const BakedMap& baked, const Stages& stages);

nlohmann::ordered_json results_json(const MeshBakeRequest& request, const BakedMap& baked,
                                    const Stages& stages);

}  // namespace relief::tools
