// SPDX-License-Identifier: Apache-2.0
/// \file
/// The surroundings: which images, laid out how, and what they do.
/// Tests: tests/tools/relief_view_test.cpp, tests/tools/scene_options_test.cpp.
#pragma once

#include "view_options.h"

namespace relief::tools {

void add_environment_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if one of them says nothing without another
void check_environment(const ViewOptions& options);

/// The environment that the options name. \throws FileError if a folder lacks one of six images, or
/// one image's shape is of no layout and none is named
Environment environment_of(const ViewOptions& options);

/// What materials do with the environment beside what their files say.
void set_reflection(Material& material, const ViewOptions& options);

}  // namespace relief::tools
