// SPDX-License-Identifier: Apache-2.0
/// \file
/// docs/hard-cases.md as the catalogue has it. Tests: hard_cases_test.cpp.
#pragma once

#include <string>

namespace relief::test {

/// The whole page, in Markdown.
std::string hard_cases_page();

}  // namespace relief::test
