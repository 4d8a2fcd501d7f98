// SPDX-License-Identifier: Apache-2.0
/// \file
/// The report of `relief make` as one HTML page, which loads nothing and can be read on a phone.
/// Tests: tests/make/make_page_test.cpp.
#pragma once

#include <filesystem>
#include <string>

#include "make_job.h"

namespace relief::tools {

/// Writes the page. If nothing can be drawn, the page says why and has no pictures of the models.
/// \param command        the line that repeats the job
/// \param has_live_view  the page has the models in it, to be orbited
/// \throws FileError
void write_make_page(const std::filesystem::path& file, const MakeRequest& request, const Job& job,
                     const MadeAsset& made, const Stages& stages, const std::string& command,
                     bool has_live_view = true);

}  // namespace relief::tools
