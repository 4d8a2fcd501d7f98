// SPDX-License-Identifier: Apache-2.0
/// \file
/// Continues an asset with the maps of --keep-stages, which may have been edited.
/// Tests: tests/make/make_baked_test.cpp.
#pragma once

#include <filesystem>

#include "common/text.h"
#include "make_job.h"
#include "relief/make/asset.h"
#include "relief/mesh/report.h"

namespace relief::tools {

/// Returns what stages.json has of a bake: the hashes of the maps, the ranges of further layers,
/// the factors without a map, and the numbers of the report. \param folder  with the maps
Json baked_record(const std::filesystem::path& folder, const make::Asset& asset);

/// Reads the asset whose mesh and maps are files of stages.
///
/// An edited map may have other bits or channels, from which those of the asset are made; its size
/// must be the same.
/// \param start  the mesh after "frames"
/// \param record  stages.json
/// \param report  counts maps that were edited, and files of maps that were not baked
/// \throws FileError if a map is missing or does not fit, or if the record is damaged
make::Asset read_baked(const MakeRequest& request, const make::AssetSource& source,
                       make::AssetStart start, const Json& record, Report& report);

}  // namespace relief::tools
