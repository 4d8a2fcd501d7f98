// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tables of docs/tangents.md: how far methods and encodings of tangent frames are from the
/// truth, measured. Times are not in them; bench/frame_costs_bench.cpp has those.
#pragma once

#include <vector>

#include "support/error_page.h"

namespace relief::test {

/// Markdown. The same on every machine and for every compiler.
std::vector<PageSection> tangent_error_sections();

}  // namespace relief::test
