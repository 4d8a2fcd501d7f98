// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of a report's page that are text and tables, as HTML that can be read without a
/// script. Tests: tests/tools/accuracy_page/report_html_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace relief::tools {

/// <dt> and <dd> of the machine, versions and settings.
std::string machine_html(const nlohmann::ordered_json& report);

/// The list of subjects with links to their experiments.
std::string contents_html(const nlohmann::ordered_json& report);

/// Each subject with what its experiments found.
std::string summary_html(const nlohmann::ordered_json& report);

/// A section a subject, an article an experiment. \throws FileError for a picture that is missing
std::string experiments_html(const nlohmann::ordered_json& report,
                             const std::filesystem::path& folder);

}  // namespace relief::tools
