// SPDX-License-Identifier: Apache-2.0
/// \file
/// What an asset lost against its source, as relief/shade/fidelity.h measures
/// it: a table, text and JSON. Tests: tests/make/make_page_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/summary.h"
#include "relief/shade/fidelity.h"

namespace relief::tools {

/// A row of the table of loss.
struct LossRow {
    std::string name;  ///< "FLIP, studio"
    double mean = 0.0;
    std::optional<double> p95;
    std::size_t worst_view = 0;
    double worst = 0.0;  ///< The mean of that view.
    double floor = 0.0;  ///< The source against itself with other samples.
};
/// The pictures with each light, degrees between normals, and the width of
/// silhouettes in pixels.
std::vector<LossRow> loss_rows(const shade::Fidelity& loss);

std::vector<std::string> loss_lines(const shade::Fidelity& loss);
Json loss_json(const shade::Fidelity& loss);

}  // namespace relief::tools
