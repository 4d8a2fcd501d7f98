// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines the results of accuracy experiments: methods on one input, each with its error against a
/// ground truth and its cost. All reports are written from this data (tables, JSON, CSV, HTML).
/// Tests: tests/accuracy/experiment_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/error_stats.h"
#include "relief/mesh/image.h"
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/timing.h"

namespace RELIEF_API relief {

class PassHistory;  // measure.h

/// The subjects of experiments, with the names of `relief-accuracy run`.
enum class Subject { normals, tangents, bump, storage, bake, shading, stability };

/// Returns statistics with NaN instead of zeros if there is no defined error, for reports.
ErrorStats nan_if_empty(const ErrorStats& error);

/// Returns the value of a curve (CurvePoint::error): the RMS; NaN without errors, or if any error
/// is undefined, so that it is not hidden in a mean.
double curve_error(const ErrorStats& error);

/// The time of each counted repetition in seconds, in order. Methods of an experiment are
/// interleaved, so round i of all methods was measured at about the same time.
struct Timing {
    std::vector<double> rounds{};

    [[nodiscard]] TimeStatistics spread() const { return time_statistics(rounds); }
    friend bool operator==(const Timing&, const Timing&) = default;
};

/// The cost of a method. A value is absent if it was not measured or does not apply.
struct Cost {
    std::optional<Timing> one_thread{};
    std::optional<Timing> all_threads{};
    /// Peak memory in addition to the memory before the call.
    std::optional<std::uint64_t> peak_bytes{};
    /// Stored bytes per result (a vertex's frame, a texel); 0 if irrelevant.
    double stored_bytes = 0.0;

    friend bool operator==(const Cost&, const Cost&) = default;
};

/// One method on the experiment's input.
struct Measurement {
    std::string method{};  ///< Unique in its experiment, and the same in every run: "max, float64".
    /// The options of the method and their values: {"weighting", "max"}, {"arithmetic", "float64"}.
    std::vector<std::pair<std::string, std::string>> choices{};
    ErrorStats error{};  ///< NaN if there is no defined error (nan_if_empty()).
    Cost cost{};
    /// Both parts of the error, if the reference has an error (Experiment::reference_error).
    std::optional<ExpectedError> expected{};
    bool is_pareto_optimal =
        false;           ///< Pareto-optimal by RMS error and time (mark_pareto_optimal()).
    std::string note{};  ///< A note for readers; mostly empty.
};

/// Returns the median seconds on one thread, or on all threads if only those were timed, or NaN.
double median_seconds(const Measurement& measurement);

/// The error as a function of a parameter: cells of a mesh, texels of a wave, the scale of a mesh.
struct CurvePoint {
    double x = 0.0;
    double error = 0.0;  ///< RMS, in the unit of the experiment; NaN: no usable result.
};
struct Curve {
    std::string method{};
    std::vector<CurvePoint> points{};  ///< In increasing order of x.
    std::optional<double> order{};     ///< The fitted slope on logarithmic axes (fitted_order()).
    std::optional<double> expected_order{};  ///< The theoretical order.
    std::optional<double> breaks_at{};       ///< The first x whose error exceeds the chart's bound.
};
struct Chart {
    std::string id{};  ///< Unique in its experiment.
    std::string title{};
    std::string x_label{};  ///< With its unit.
    std::string y_label{};
    bool is_x_log = true;
    std::optional<double> bound{};  ///< A larger error counts as a failure.
    std::vector<Curve> curves{};
};

/// The errors over a map or picture: one float channel, in the unit of the experiment.
struct HeatMap {
    std::string title{};
    std::string method{};
    Image errors{};
    double brightest = 1.0;
};

/// Two pictures to compare with a slider.
struct PicturePair {
    std::string title{};
    std::string before_label{};
    std::string after_label{};
    Image before{};  ///< 8-bit sRGB, 3 or 4 channels.
    Image after{};   ///< Of the same size.
};

struct Experiment {
    std::string id{};  ///< The same in every run: "normals/torus-jittered".
    Subject subject = Subject::normals;
    std::string title{};
    std::string question{};      ///< One sentence that ends with a question mark.
    std::string ground_truth{};  ///< The ground truth, and how it is known.
    /// The expected RMS error of this ground truth; absent if there is none or it is unknown.
    std::optional<double> reference_error{};
    std::string input{};       ///< "torus, jittered, 64 x 64 cells: 8192 triangles"
    std::string error_unit{};  ///< "degrees", "FLIP"
    std::string item{};        ///< The unit of work: "triangle", "texel", "pixel".
    double items = 0.0;
    /// The command that repeats the experiment: "relief-accuracy run normals"; the tool fills it
    /// in.
    std::string command{};
    std::vector<Measurement> measurements{};
    std::vector<Chart> charts{};
    std::vector<HeatMap> heat_maps{};
    std::vector<PicturePair> pictures{};
    /// The conclusion in one or two sentences with figures, generated from the measurements.
    std::string finding{};
    /// Problems of the input and how they were handled, one sentence each.
    std::vector<std::string> input_findings{};
};

/// Options for running experiments.
struct RunOptions {
    /// Uses small inputs: all subjects take about a minute per pass on two cores.
    bool is_quick = false;
    Repeats repeats{10, 1};
    /// If false, only errors are computed. They are the same on every machine, except for those of
    /// pictures drawn by OpenGL.
    bool is_timed = true;
    /// The number of threads for "all threads"; 0: the number of hardware threads.
    unsigned threads = 0;
    /// The rounds of earlier passes, filled in by run_in_passes(); null if there is one pass.
    std::shared_ptr<PassHistory> earlier{};
    /// Called before each experiment with its title, the number of finished experiments and the
    /// total. May throw Cancelled.
    std::function<void(const std::string& title, std::size_t done, std::size_t total)> tell{};
};

/// The error and time of a method, in any unit; smaller is better. NaN means unknown.
struct MethodCost {
    double error = 0.0;
    double time = 0.0;
};

/// Finds the Pareto-optimal methods.
///
/// \return for each method, true if no other is better in one value and at least as good in the
///         other. Equal methods have equal results. A method with NaN is never Pareto-optimal and
///         does not affect the others
std::vector<bool> pareto_optimal(std::span<const MethodCost> prices);

/// Marks the measurements that are Pareto-optimal by RMS error and time on one thread, or on all
/// threads if only that was measured. Without times none is marked. Measurements with undefined
/// results are never marked.
void mark_pareto_optimal(Experiment& experiment);

/// Computes the slope of log(error) over log(x) by least squares, from the points whose coordinates
/// are positive and finite.
/// \return nothing for fewer than two different x
std::optional<double> fitted_order(const std::vector<CurvePoint>& points);

/// Returns the subjects that have experiments, in the order of reports.
std::vector<Subject> subjects_with_experiments();

/// Returns true if some of its experiments draw with OpenGL, so that their errors depend on the
/// renderer.
bool uses_opengl(Subject subject);

/// Returns the name: "normals", "tangents", ...
std::string_view name_of(Subject subject);

/// Returns the subject of this name. \throws InvalidInput listing the valid names
Subject subject_from(std::string_view word);

/// Formats a time: "840 ns", "4.13 µs", "12.3 ms", "1.50 s".
std::string format_seconds(double seconds);

/// Runs the experiments of one subject.
std::vector<Experiment> run_experiments(Subject subject, const RunOptions& options);

}  // namespace relief
