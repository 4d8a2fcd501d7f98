// SPDX-License-Identifier: Apache-2.0
/// \file
/// Whether the high and the low model belong together: sizes and places of their boxes, and the
/// share of texels whose rays hit nothing, in words, with the likely cause.
/// Tests: tests/tools/relief_bake_fit_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mesh/bake_models.h"
#include "mesh/mesh_options.h"
#include "relief/mesh/bake.h"

namespace relief::tools {

/// --max-missed and --allow-size-mismatch. \param consequence  what happens beyond --max-missed
void add_fit_options(CLI::App& app, MeshBakeRequest& request, const std::string& consequence);

/// --max-missed, or its default, in percent.
double missed_limit(const MeshBakeRequest& request);

/// Missed texels in percent of those that the low model covers; 0 if it covers none.
double missed_percent(std::size_t missed, std::size_t baked);

/// Makes the baker; a BakeMismatch becomes a FileError that names files, boxes and the likely
/// cause.
Baker make_baker(const MeshBakeRequest& request, const BakeModels& models,
                 const BakeOptions& options, Report& report);

/// The likely cause and the boxes: "high.obj is 100 times as large ...: one in meters, ...?".
std::string fit_words(const MeshBakeRequest& request, const BakeModels& models);

/// \param map  its name, where there are several; empty: the only one
/// \throws FileError if no ray hits, or too many texels are missed
void check_missed(const MeshBakeRequest& request, const BakeModels& models, const std::string& map,
                  const BakeResult& result);

/// Bakes small versions of large maps, to find out before the bake that too much is missed.
/// \param always  of small maps too
/// \throws FileError as check_missed(), where a small version is 5 percent points beyond the limit
void check_missed_early(const MeshBakeRequest& request, const BakeModels& models,
                        const Baker& baker, const BakeMapOptions& map, const std::string& name,
                        bool always);

/// Which texels are missed, where they are, and the ray lengths that would hit.
std::vector<std::string> missed_lines(const MeshBakeRequest& request, const BakeResult& result,
                                      const glm::dvec3& origin);
nlohmann::ordered_json missed_json(const BakeResult& result, const glm::dvec3& origin);

/// The boxes in the world, their gap and the ratio of their sizes.
nlohmann::ordered_json boxes_json(const BakeFit& fit, const glm::dvec3& origin);

/// A warning if the low model has many more triangles than the high one; else empty.
std::string words_of_swapped_models(const MeshBakeRequest& request, std::size_t high_triangles,
                                    std::size_t low_triangles);

}  // namespace relief::tools
