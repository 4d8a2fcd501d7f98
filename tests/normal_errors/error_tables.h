// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tables of docs/normals.md: how far each weighting is from the truth, measured. Times are not
/// in them; bench/mesh/normals_bench.cpp has those.
#pragma once

#include <string>

namespace relief::test {

/// Markdown. The same on every machine and for every compiler.
std::string normal_error_tables();

/// The line before them in the page (support/error_page.h).
inline constexpr const char* tables_begin =
    "<!-- tables: written by relief-normal-errors-page -->\n";

}  // namespace relief::test
