// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tables of a report's page. They are also what its script takes the words of tooltips from,
/// so that each number is written in one way. Tests:
/// tests/tools/accuracy_page/report_html_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace relief::tools {

/// A row a method: errors, times, memory; columns for which nothing was measured are left out.
std::string measurements_table(const nlohmann::ordered_json& experiment);

/// A row an x, a column a curve; below, fitted and expected slopes and where curves break.
std::string chart_table(const nlohmann::ordered_json& chart);

}  // namespace relief::tools
