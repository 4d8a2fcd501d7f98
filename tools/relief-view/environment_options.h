// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options of the environment and of reflection. Tests: tests/tools/scene_options_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/options.h"
#include "relief/shade/scene.h"
#include "view_options.h"

namespace relief::tools {

void add_environment_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if an option needs another one
void check_environment(const ViewOptions& options);

/// Returns whether the environment is the built-in studio.
bool uses_studio(const ViewOptions& options);

/// Returns whether --environment none removes the environment.
bool uses_no_environment(const ViewOptions& options);

/// The environment of the options.
/// \throws FileError if a folder does not have six images, or if the layout of an image is unclear
shade::Environment environment_of(const ViewOptions& options);

/// Sets what the reflection options, whose fields the material has already, imply for others: the
/// indices of a conductor, and reflectivities.
void complete_reflection(Material& material, const ViewOptions& options);

/// Sets the environment of a scene from the options, the scene file or the default studio.
/// \param notes  receives messages for the user
/// \throws UsageError if an option would have no effect
void set_environment(shade::Scene& scene, const ViewOptions& options,
                     std::vector<std::string>& notes);

}  // namespace relief::tools
