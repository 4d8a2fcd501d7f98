// SPDX-License-Identifier: Apache-2.0
/// \file
/// An asset from file to file: reading the dense model, the stages of relief/make/asset.h, writing,
/// verification, and the summary. Tests: tests/tools/relief_make_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/file_jobs.h"
#include "common/summary.h"
#include "engines.h"
#include "relief/make/asset.h"

namespace relief::tools {

struct MakeRequest {
    make::AssetOptions asset;
    Engine engine = Engine::gltf;
};

/// What is known of the dense model after it is read.
struct SourceFacts {
    std::string format;  ///< "glTF"
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    std::string textures;  ///< HighTextures::description()
};

/// Reads a dense model in world space with its materials and textures.
///
/// Textures that are missing are left out, which is reported; so are cameras, lights, points and
/// lines.
/// \throws FileError if it cannot be read, or if it has skins, morph targets or animations, which
///         the asset would lose
make::AssetSource read_source(const std::filesystem::path& file, SourceFacts& facts,
                              Findings& findings);

/// The peak memory of the process at the end of a stage.
struct StageMemory {
    std::string stage;
    std::uint64_t peak_bytes = 0;
};

struct MadeAsset {
    SourceFacts source;
    make::Asset asset;
    std::vector<make::AssetLevel> levels;
    std::vector<std::filesystem::path> files;
    std::vector<StageMemory> memory;
    Findings findings;
};

/// The files of a job: the asset, and for some engines its maps.
std::vector<std::filesystem::path> outputs_of(const MakeRequest& request,
                                              const std::filesystem::path& output);

/// Reads, makes, writes and verifies an asset. The stages are those of make::stages_of() between
/// "read", and "write" and "verify". All files are replaced together at the end.
/// \throws FileError, UsageError; then no file is changed
MadeAsset make_file(const MakeRequest& request, const Job& job, Stages& stages);

Summary summary_of(const MakeRequest& request, const Job& job, const MadeAsset& made,
                   const Stages& stages);

/// A line of a batch.
std::string line_of(const Job& job, const MadeAsset& made, const Stages& stages);

}  // namespace relief::tools
