// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on stability: inputs become ever smaller, larger, farther from the origin, narrower
/// or steeper, until the results of a method are wrong. docs/hard-cases.md lists single hard
/// inputs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// Runs all experiments below.
std::vector<Experiment> stability_experiments(const RunOptions& options);

Experiment normals_by_scale(const RunOptions& options);
Experiment normals_by_offset(const RunOptions& options);
Experiment normals_of_needles(const RunOptions& options);
Experiment normals_beside_hard_triangles(const RunOptions& options);
Experiment tangents_by_scale(const RunOptions& options);
Experiment tangents_by_offset(const RunOptions& options);
Experiment bump_by_steepness(const RunOptions& options);
Experiment bump_by_offset(const RunOptions& options);

/// The errors of several methods while one quantity grows, and the value at which each method
/// fails.
class Sweeps {
  public:
    /// \param bound  limit of the RMS error in degrees; a method fails where it exceeds this
    Sweeps(std::vector<std::string> methods, double bound);

    /// The angular errors of a method at a value, in degrees; NaN where a direction is undefined.
    using Errors = std::function<std::vector<float>(std::size_t method, double value)>;

    /// Adds a chart over the values 10^0, 10^step, ... 10^decades.
    void add(const std::string& id, const std::string& title, const std::string& x_label,
             int decades, int step, const Errors& errors);

    [[nodiscard]] const std::vector<Chart>& charts() const { return charts_; }

    /// The errors of a method in all charts together.
    [[nodiscard]] ErrorStats figures(std::size_t method) const;

    /// "Larger (...): plain area fails from 1e+18 on, all others are within the limit." for each
    /// chart.
    [[nodiscard]] std::string breaks() const;

  private:
    std::vector<std::string> methods_;
    double bound_;
    std::vector<Chart> charts_;
    std::vector<std::vector<float>> degrees_;  ///< By method, from all charts.
};

}  // namespace relief
