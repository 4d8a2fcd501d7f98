// SPDX-License-Identifier: Apache-2.0
/// \file
/// The loss of an asset against its source, as relief/shade/fidelity.h measures it, after each
/// stage that can lose something: tables, text and JSON. Tests: tests/make/make_loss_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/summary.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/topology.h"
#include "relief/shade/fidelity.h"

namespace relief::tools {

/// A stage between the source and a level of detail. Its loss is that after the stage, and not
/// caused by it: a stage can hide what another one lost.
struct LossStage {
    std::string name;  ///< "decimated", "baked", "coded" (the asset), "LOD1", "LOD2", ...
    std::size_t triangles = 0;
    shade::SampledFidelity loss;
    SurfaceDistance distance;  ///< a is the source.
};

struct AssetLoss {
    shade::Fidelity fidelity;  ///< Of the asset.
    double diagonal = 0.0;     ///< Of the source's box.
    std::vector<LossStage> stages;
};

/// A row of the table of loss.
struct LossRow {
    std::string name;  ///< "FLIP, studio"
    double mean = 0.0;
    std::optional<double> rms;  ///< Only if limits apply to it.
    std::optional<double> p95;
    std::optional<double> p99;
    std::optional<double> max;
    std::size_t worst_view = 0;
    double worst = 0.0;  ///< The mean of that view.
    double floor = 0.0;  ///< The source against itself with other samples.
};
/// The pictures with each light, degrees between normals, and the width of silhouettes in pixels.
/// \param limited  the statistic of limits, which the row of normals has
std::vector<LossRow> loss_rows(const shade::Fidelity& loss, ErrorKind limited);

/// A row of the table of distances, in units of the model.
struct DistanceRow {
    std::string name;  ///< "source to LOD1", "LOD1 to source"
    double mean = 0.0;
    double p95 = 0.0;
    double max = 0.0;
};
/// Both directions for each surface: the asset and its levels.
std::vector<DistanceRow> distance_rows(const AssetLoss& loss);

/// "0.0012 (0.069 %)": a distance, and its part of the diagonal.
std::string distance_text(double distance, double diagonal);

/// The noise floor, which has means only.
shade::SampledFidelity sampled_floor(const shade::Fidelity& loss);

/// The views of the stages, for headings: "views 0, 4 and 8".
std::string sampled_views_text(const shade::Fidelity& loss);

std::vector<std::string> loss_lines(const AssetLoss& loss, ErrorKind limited);
Json loss_json(const AssetLoss& loss);

}  // namespace relief::tools
