// SPDX-License-Identifier: Apache-2.0
/// \file
/// The option --shard K/N: a command does the part K of N of its work, so that several machines
/// share it. Tests: tests/tools/relief_bake_shards_test.cpp, farm_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/options.h"

namespace relief::tools {

/// The value of --shard.
struct ShardChoice {
    std::size_t shard = 1;  ///< From 1.
    std::size_t count = 1;
};

/// Parses "3/16". \throws UsageError
inline ShardChoice parse_shard(const std::string& subject, const std::string& text) {
    constexpr int max_shards = 100'000;
    const std::vector<std::string> words = split(text, '/');
    if (words.size() != 2) throw UsageError(subject + ": is not K/N", "write 3/16");
    const int count = parse_integer(subject, words[1], 1, max_shards);
    const int shard = parse_integer(subject, words[0], 1, count);
    return {static_cast<std::size_t>(shard), static_cast<std::size_t>(count)};
}

/// Adds --shard with its heading.
inline void add_shard_option(CLI::App& app, std::optional<ShardChoice>& target,
                             const std::string& description) {
    add_value(app, "--shard", "K/N", description,
              [&target](const std::string& subject, const std::string& text) {
                  target = parse_shard(subject, text);
              })
        .group("Several machines");
}

/// Keeps every N-th job, from the K-th on: together, the shards have each job once.
template <typename Job>
void keep_shard(const std::optional<ShardChoice>& choice, std::vector<Job>& jobs) {
    if (!choice) return;
    std::vector<Job> kept;
    for (std::size_t i = choice->shard - 1; i < jobs.size(); i += choice->count)
        kept.push_back(std::move(jobs[i]));
    jobs = std::move(kept);
}

}  // namespace relief::tools
