// SPDX-License-Identifier: Apache-2.0
/// \file
/// Checks JSON against docs/accuracy-schema.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace relief::test {

/// A row of a table: "experiments[].id", "string or null, optional".
struct SchemaRow {
    std::string place;
    std::string kind;
};

/// Returns the rows below a heading of the page, "## compare --json".
std::vector<SchemaRow> schema_rows(const std::string& heading);

/// Returns a line for each value that is not in the rows or has another type, and for each missing
/// value.
///
/// \param is_complete  whether optional values must occur, too
std::vector<std::string> schema_faults(const nlohmann::json& json,
                                       const std::vector<SchemaRow>& rows, bool is_complete);

}  // namespace relief::test
