// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a report holds, counted by kind, for comparing with what a row of the catalogue expects.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/report.h"

namespace relief::test {

std::map<std::string, std::size_t> counts_of(const Report& report);

/// "2 x needle triangle, 1 x isolated vertex"; "nothing".
std::string as_text(const std::map<std::string, std::size_t>& counts);

/// For the page: "; reported: 2 x needle triangle"; empty if nothing is.
std::string reported(const std::vector<std::pair<std::string, std::size_t>>& findings);

}  // namespace relief::test
