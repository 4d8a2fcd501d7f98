// SPDX-License-Identifier: Apache-2.0
/// \file
/// Bakes that several processes share: each bakes a part of the rows, and the merge makes the maps
/// that one process would have made, byte for byte. Tests: tests/tools/relief_bake_shards_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/shard_choice.h"
#include "mesh_bake.h"
#include "mesh_request.h"
#include "part_file.h"

namespace relief::tools {

/// A command line of `relief-bake mesh` without the options of the process and of shards.
struct MeshArguments {
    std::vector<std::string> options;  ///< "--size=512"
    std::vector<std::filesystem::path> files;
};

/// Reads a command line like `relief-bake mesh`.
/// \throws UsageError
MeshBakeRequest parse_mesh_request(const MeshArguments& arguments);

/// \throws UsageError if an option needs the whole map, or the models after the bake
void check_sharded(const MeshBakeRequest& request);

struct BakedShard {
    std::filesystem::path file;
    Part part;
};

/// Bakes a shard and writes its part.
/// \param file  absent: OUT.JOB-K-of-N.part, where JOB is PartJob::hash()
/// \throws FileError, UsageError
BakedShard bake_shard(const MeshBakeRequest& request, const MeshArguments& arguments,
                      const ShardChoice& choice, const std::optional<std::filesystem::path>& file,
                      Stages& stages);

/// Checks that the parts are all parts of one bake, and sorts them by shard.
/// \throws FileError that names parts of other bakes, repeated and missing parts
void sort_parts(std::vector<std::unique_ptr<PartFile>>& parts);

/// Writes the maps from all parts. The stages are "merge" and that of the shards, "bake".
/// \throws FileError, UsageError
MeshBake merge_parts(const MeshBakeRequest& request,
                     const std::vector<std::unique_ptr<PartFile>>& parts, Stages& stages);

}  // namespace relief::tools
