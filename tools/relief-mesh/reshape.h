// SPDX-License-Identifier: Apache-2.0
/// \file
/// The measured distances of meshes, for the commands that change triangles.
#pragma once

#include <vector>

#include "common/summary.h"
#include "relief/mesh/topology.h"

namespace relief::tools {

/// Returns the positions and triangles.
Mesh without_attributes(const Mesh& mesh);

/// Joins the distances of several meshes. Means are over area.
SurfaceDistance joined_distance(const std::vector<SurfaceDistance>& distances);

/// {"mean", "rms", "max", "mean_degrees", "max_degrees",
/// "omitted"}
Json distance_json(const DistanceStats& stats);

}  // namespace relief::tools
