// SPDX-License-Identifier: Apache-2.0
/// \file
/// docs/accuracy-schema.md as something to hold JSON against.
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

/// The rows below a heading of the page, "## compare --json".
std::vector<SchemaRow> schema_rows(const std::string& heading);

/// What stands in the JSON and not in the rows, or is of another kind; and what must stand in each
/// object that is there and does not. One line each.
///
/// \param is_complete  what is optional must occur somewhere too
std::vector<std::string> schema_faults(const nlohmann::json& json,
                                       const std::vector<SchemaRow>& rows, bool is_complete);

}  // namespace relief::test
