// SPDX-License-Identifier: Apache-2.0
/// \file
/// The index of a batch of `relief make` as one HTML page, which loads nothing.
/// Tests: tests/make/make_index_test.cpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "make_job.h"

namespace relief::tools {

/// Returns what the index tells about an asset besides its file: "source_triangles", "triangles",
/// "flip" and "degrees" (null if not measured), and "findings".
Json index_facts(const MadeAsset& made);

/// A model of a batch.
struct IndexEntry {
    Job job;
    std::string error;  ///< Why there is no asset; empty: there is one.
    Json facts;         ///< Of index_facts(); null if they are unknown.
};

/// Sorts models: failed ones, then by FLIP, then by the number of findings, largest first; equal
/// ones keep their order.
void sort_worst_first(std::vector<IndexEntry>& entries);

/// Writes the page with a picture of each asset. If nothing can be drawn, the page says why.
/// \throws FileError
void write_make_index(const std::filesystem::path& file, const std::string& name,
                      std::vector<IndexEntry> entries);

}  // namespace relief::tools
