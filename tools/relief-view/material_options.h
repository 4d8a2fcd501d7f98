// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which model materials follow, where light is computed, and highlights, for all materials.
/// Tests: tests/tools/relief_view_test.cpp.
#pragma once

#include "view_options.h"

namespace relief::tools {

void add_material_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if one contradicts another
void check_materials(const ViewOptions& options);

/// Why glTF's materials are to be shown as Phong's: the first option that only Phong's model has,
/// or --shading phong; empty if none was given.
std::string reason_for_phong(const ViewOptions& options);

}  // namespace relief::tools
