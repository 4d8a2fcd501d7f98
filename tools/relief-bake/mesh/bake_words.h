// SPDX-License-Identifier: Apache-2.0
/// \file
/// How a map was baked, as the options that say so: kept in its file, so that it can be checked
/// without being told again. Tests: tests/tools/relief_bake_verify_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "mesh/mesh_options.h"
#include "mesh/mesh_sets.h"

namespace relief::tools {

/// By option, what it was given: {"--samples", "4"}.
using BakeWords = std::map<std::string, std::string>;

/// Text entries of a map's file: "relief:bake" = "--samples 4 --space tangent", in order of names;
/// "relief:material" and "relief:udim", where the map is one of several. A cage is not named:
/// "--cage given".
std::map<std::string, std::string> bake_metadata(const MeshBakeRequest& request,
                                                 const MapPlan& plan);

/// What a file says; empty where it says nothing.
/// \throws FileError if it says what are no such words
BakeWords bake_words(const std::filesystem::path& file,
                     const std::map<std::string, std::string>& metadata);

/// What a command line says that has add_ray_options() and add_texel_options().
BakeWords bake_words(const CLI::App& app);

/// What is told, and of what is not, what the file says; --rays, --hardness and --offset of the
/// file are dropped where a cage is told.
BakeWords joined(const BakeWords& told, const BakeWords& of_file);

/// Fills in rays, texels and dither by words. \throws UsageError as the options do
void apply_words(const BakeWords& words, MeshBakeRequest& request);

/// "--samples 4 --space tangent"
std::string in_line(const BakeWords& words);

}  // namespace relief::tools
