// SPDX-License-Identifier: Apache-2.0
/// \file
/// Shards of `relief check`: each checks every N-th model, and reads every N-th image and those
/// that only its models name. How an image is used may be known only to another shard; so a part
/// has what an image holds, and the merge judges it for all of its uses.
/// Tests: tests/check/check_shards_test.cpp, tests/fuzz/fuzz_targets_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "check_files.h"
#include "check_item.h"
#include "check_run.h"
#include "check_walk.h"
#include "common/part_job.h"
#include "common/shard_choice.h"

namespace relief::tools {

/// The results of a shard. Its file has the line "relief check part 1 HASH", with the hash of the
/// rest, and a JSON object.
struct CheckPart {
    PartJob job;
    std::size_t shard = 0;
    WalkedFiles walked;  ///< Only in the first part.
    std::vector<CheckedItem> models;
    std::vector<ImageFacts> images;
};

/// Returns a hash of the names, kinds and sizes of files.
std::string hash_of(const WalkedFiles& walked);

/// Checks a share of the files. \param part  with its job and shard
void check_shard(const WalkedFiles& walked, CheckPart& part, Stages& stages);

/// \throws FileError
void write_part(const std::filesystem::path& file, const CheckPart& part);

/// \throws FileError if the file is not a part, or is damaged or inconsistent
CheckPart read_check_part(const std::filesystem::path& file);

/// Returns a source of what the parts have. Images that are used in a way which no part foresaw are
/// read again.
/// \param parts  of one check, by shard; they must outlive the source
/// \throws FileError if a part does not have its share
CheckSource merged_source(const std::vector<CheckPart>& parts,
                          const std::vector<std::filesystem::path>& names);

}  // namespace relief::tools
