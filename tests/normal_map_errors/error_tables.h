// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tables of docs/normal-maps.md: what blending, resizing, storing and mip levels do to
/// normals, measured against surfaces of waves. Times are not in them;
/// bench/mesh/normal_maps_bench.cpp has those.
#pragma once

#include <string>

#include "support/error_page.h"

namespace relief::test {

// Markdown. The same on every machine and for every compiler.
std::string blend_tables();
std::string resize_tables();
std::string storage_tables();
std::string mip_tables();

/// All of them, each with the line before it in the page.
std::vector<PageSection> normal_map_tables();

}  // namespace relief::test
