// SPDX-License-Identifier: Apache-2.0
/// \file
/// Errors of several methods while one thing grows, and where each of them breaks.
/// Tests: tests/accuracy/sweep_test.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

/// What errs by more is broken.
inline constexpr double broken_degrees = 1.0;

class Sweeps {
  public:
    /// \param bound  of the RMS error, in degrees: what is beyond it is broken
    Sweeps(std::vector<std::string> methods, double bound);

    /// Degrees of each direction, NaN where there is none, by a method at a value.
    using Errors = std::function<std::vector<float>(std::size_t method, double value)>;

    /// Adds a chart: values are 10^0, 10^step, ... 10^decades.
    void add(const std::string& id, const std::string& title, const std::string& x_label,
             int decades, int step, const Errors& errors);

    [[nodiscard]] const std::vector<Chart>& charts() const { return charts_; }

    /// Of a method, everywhere together.
    [[nodiscard]] ErrorFigures figures(std::size_t method) const;

    /// "larger: plain area, float32 breaks at 1e+18; all others hold". One for each chart.
    [[nodiscard]] std::string breaks() const;

  private:
    std::vector<std::string> methods_;
    double bound_;
    std::vector<Chart> charts_;
    std::vector<std::vector<float>> degrees_;  ///< By method, all there are.
};

}  // namespace relief
