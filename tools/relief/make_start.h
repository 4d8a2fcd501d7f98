// SPDX-License-Identifier: Apache-2.0
/// \file
/// Continues an asset with the files of --keep-stages. The file stages.json of their folder records
/// from what they were made. Tests: tests/make/make_start_test.cpp.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "common/text.h"
#include "make_job.h"
#include "relief/make/asset.h"
#include "relief/make/stage_file.h"
#include "relief/mesh/report.h"

namespace relief::tools {

/// The layouts of files, by their names.
using StageLayouts = std::map<std::string, make::StageLayout>;

/// Writes stages.json. \throws FileError
/// \param inputs  every file that was read
/// \param layouts  of the files that were written
/// \param before  the record of the files of earlier stages; null if all stages ran
/// \return the file
std::filesystem::path write_stage_record(const std::filesystem::path& folder,
                                         const make::Asset& asset, const MakeRequest& request,
                                         const std::vector<std::filesystem::path>& inputs,
                                         const StageLayouts& layouts, const Json& before);

/// Returns stages.json. \throws FileError if it is missing or damaged
Json read_stage_record(const std::filesystem::path& folder);

/// Reads the mesh with which a stage begins; for "write", the mesh of the maps (make_baked.h).
///
/// \param record  read_stage_record()
/// \param origin  of the positions of the source
/// \param report  counts a file that was edited
/// \return for "remesh", without triangles if the file was not edited: nothing is left out then
/// \throws FileError if the file is missing, or if the files are stale: the model or
///         an option of an earlier stage has changed, or a file of an earlier stage was edited
make::AssetStart read_start(const Json& record, const std::filesystem::path& folder,
                            const std::string& stage, const MakeRequest& request,
                            const std::vector<std::filesystem::path>& inputs,
                            const glm::dvec3& origin, Report& report);

}  // namespace relief::tools
