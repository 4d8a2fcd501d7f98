// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tables of docs/normals.md: how far each weighting is from the truth, measured. Times are not
/// in them; bench/mesh/normals_bench.cpp has those.
#pragma once

#include <string>

namespace relief::test {

/// Markdown. The same on every machine and for every compiler.
std::string normal_error_tables();

/// What stands in the page around them, so that they can be put in and compared.
inline constexpr const char* tables_begin =
    "<!-- tables: written by relief-normal-errors-page -->\n";
inline constexpr const char* tables_end = "<!-- end of tables -->\n";

}  // namespace relief::test
