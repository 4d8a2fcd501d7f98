// SPDX-License-Identifier: Apache-2.0
/// \file
/// Maps, highlights and reflection that the command line puts on all materials of a scene.
/// Tests: tests/tools/scene_options_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"
#include "view_options.h"

namespace relief::tools {

/// Replaces what the options name in every material. Meshes without a material get the default one
/// first, so that "all materials" leaves nothing out.
///
/// \param notes  gets what the reader should know: meshes that a map cannot cover, highlights
/// added \throws UsageError if an option could show nowhere; FileError if a map is asked for and no
/// mesh
///         has texture coordinates, or the height map cannot be read
void override_materials(Scene& scene, const ViewOptions& options, Stages& stages, Report& report,
                        std::vector<std::string>& notes);

/// The heights in an image as a normal map in codes of so many bits: green up, flat exactly flat.
Image converted_heights(const Image& image, const BumpOptions& bump, int bits, Report& report);

/// The kernel by which the options' height map is converted, or would be.
///
/// \return nothing for a Gaussian that the map called for, whose radius is its own
/// \throws FileError if the height map cannot be read
std::optional<Kernel> kernel_shown(const ViewOptions& options);

/// How to read such a map.
NormalMap converted_map(const Texture& texture);

}  // namespace relief::tools
