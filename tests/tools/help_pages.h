// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which --help pages there are, and the examples on them.
#pragma once

#include <string>
#include <vector>

#include "tools/workplace.h"

namespace relief::test {

/// All tools and all their commands ("relief-mesh", "relief-mesh info"), as their pages list them.
std::vector<std::string> commands_with_help(const Workplace& workplace);

/// The command lines below "Examples:" of a page.
std::vector<std::string> examples_of(const std::string& page);

}  // namespace relief::test
