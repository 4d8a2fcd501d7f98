// SPDX-License-Identifier: Apache-2.0
/// \file
/// The maps of an asset as files for an engine: `relief make --for unity|unreal`, and --layers.
/// Tests: tests/make/make_engine_test.cpp.
#pragma once

#include <filesystem>
#include <vector>

#include "engines.h"
#include "relief/make/asset.h"

namespace relief::tools {

/// The files that write_map_files() may write beside an asset: maps for some engines, and further
/// layers.
std::vector<std::filesystem::path> map_files_of(Engine engine, const make::AssetOptions& options,
                                                const std::filesystem::path& output);

/// Writes maps beside an asset, with the names, the channels and the green of an engine: normals,
/// colors, emission, and an image of occlusion, roughness and metalness. Further layers are written
/// for every engine. Engines that read the maps of glTF files get no other files.
/// \return the files
/// \throws FileError
std::vector<std::filesystem::path> write_map_files(Engine engine,
                                                   const std::filesystem::path& output,
                                                   const make::Asset& asset);

}  // namespace relief::tools
