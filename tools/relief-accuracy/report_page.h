// SPDX-License-Identifier: Apache-2.0
/// \file
/// A report as one HTML page with all numbers, pictures, style and script, which loads nothing.
///
/// Tables, text and pictures are HTML. The script (page/*.js) adds plots, sorting and filters, so
/// that the page can be read and printed without it. The page contains the JSON report.
/// Tests: tests/tools/accuracy_page/report_html_test.cpp, and report_page_test.py in a browser.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace relief::tools {

/// Returns the page of a report, given as the JSON of accuracy.json. Pictures without file (null)
/// become a note.
/// \param folder  the folder of the picture files
/// \throws FileError for a missing picture, InvalidInput for a picture outside that folder
std::string report_html(const nlohmann::ordered_json& report, const std::filesystem::path& folder);

/// A file of the folder page/.
struct ReportPart {
    std::string_view name;
    std::string_view text;
};
/// All files of page/, sorted by name. cmake/embed_files.cmake generates this function.
const std::vector<ReportPart>& report_parts();

}  // namespace relief::tools
