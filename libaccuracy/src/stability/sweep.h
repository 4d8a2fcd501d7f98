// SPDX-License-Identifier: Apache-2.0
/// \file
/// Errors of several methods while one thing grows, and where each of them breaks.
/// Tests: tests/accuracy/sweep_test.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "measured_methods.h"

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

/// The names of methods that have a `name`.
template <typename Method>
std::vector<std::string> names_of(const std::vector<Method>& methods) {
    std::vector<std::string> names;
    for (const Method& method : methods)
        names.push_back(method.name);
    return names;
}

/// What experiments by sweeps end with: a measurement of each method, with its errors of all sweeps
/// and its time on one thread, the charts, and where each method breaks.
///
/// \param methods  in the order of the sweeps; whose name begins with "plain" are not relief's, and
///                 it is said of them
void measure_swept(std::vector<MeasuredMethod> methods, const Sweeps& sweeps,
                   const RunOptions& options, Experiment& experiment);

}  // namespace relief
