// SPDX-License-Identifier: Apache-2.0
/// \file
/// The common parts of all experiments on a user's files: the selection of triangles, the rule for
/// hard edges, and the recommendation at the end.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/normals.h"

namespace relief::accuracy::detail {

/// A smaller error is invisible, and not worth a byte.
inline constexpr double invisible_degrees = 0.01;

/// The error of a method that is known already, as a function.
std::function<MethodError()> known_error(const ErrorStats& error);

/// Begins an experiment on a file: id "own/FILE/TOPIC", title "TITLE of FILE", unit degrees.
AssetExperiment asset_experiment(Subject subject, const std::string& topic,
                                 const std::string& title, const AssetOptions& options);

/// Measures the methods, recommends one of those that have a command, and makes that the finding.
/// Experiment::reference_error must be set before.
/// \param rule  all but the request, the choosable methods and the nominal costs
void finish(AssetExperiment& asset, const std::vector<Method>& methods, RecommendationRule rule,
            const AssetOptions& options);

/// Makes the recommendation and its command the finding.
void set_finding(AssetExperiment& asset);

/// Selects eight evenly spread runs of triangles, `max_triangles` in total; or the whole mesh if it
/// has no more.
Mesh part_to_measure(const Mesh& mesh, std::size_t max_triangles);

/// The rule for hard edges of a mesh; the mesh must outlive it.
struct CreaseRule {
    HardEdges edges;
    std::string description;  ///< "edges sharper than 40 degrees are hard"
    std::string option;       ///< For relief-mesh process, after a space: " --crease 40".

    [[nodiscard]] bool has_any() const {
        return edges.crease_angle.has_value() || !edges.smoothing_groups.empty();
    }
};

/// Determines which edges are hard: by the given angle; else by smoothing groups, if one is not 0;
/// else by the angle that separates the edges at which the mesh's own normals break. Below 15
/// degrees that angle only says that the mesh is stored as facets, and no edge is hard.
///
/// \param crease_angle  radians; pi: no edge is hard
CreaseRule crease_rule(const Mesh& mesh, const std::optional<double>& crease_angle);

}  // namespace relief::accuracy::detail
