// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines the results of accuracy experiments, and compares two runs of them. A result holds
/// methods on one input, each with its error against a ground truth and its cost. All reports are
/// written from this data (tables, JSON, CSV, HTML).
/// Tests: tests/accuracy/experiment_test.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {
namespace accuracy {

/// The subjects of experiments. All have some.
enum class Subject {
    normals,
    tangents,
    bump,
    storage,
    compression,
    bake,
    decimation,
    unwrapping,
    relief,
    shading,
    stability
};

}  // namespace accuracy

/// The names of `relief-accuracy run`, in the order of reports.
template <>
inline constexpr auto enum_names<accuracy::Subject> =
    std::to_array<EnumName<accuracy::Subject>>({{"normals", accuracy::Subject::normals},
                                                {"tangents", accuracy::Subject::tangents},
                                                {"bump", accuracy::Subject::bump},
                                                {"storage", accuracy::Subject::storage},
                                                {"compression", accuracy::Subject::compression},
                                                {"bake", accuracy::Subject::bake},
                                                {"decimation", accuracy::Subject::decimation},
                                                {"unwrapping", accuracy::Subject::unwrapping},
                                                {"relief", accuracy::Subject::relief},
                                                {"shading", accuracy::Subject::shading},
                                                {"stability", accuracy::Subject::stability}});

namespace accuracy {

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

/// The options of a method and their values: {"weighting", "max"}, {"arithmetic", "float64"}.
using Choices = std::vector<std::pair<std::string, std::string>>;

/// One method on the experiment's input.
struct Measurement {
    std::string method{};  ///< Unique in its experiment, and the same in every run: "max, float64".
    Choices choices{};
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
    /// The upper end of that error, if the input does not show it: it is a range. Else absent.
    std::optional<double> reference_error_upper{};
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

/// The progress of a run.
struct RunProgress {
    std::string title{};    ///< Of the next experiment.
    std::size_t pass = 0;   ///< The current pass, from 0.
    std::size_t done = 0;   ///< The number of experiments that finished this pass.
    std::size_t total = 1;  ///< The number of experiments in each pass.
};

/// Options for running experiments.
struct RunOptions {
    /// Uses small inputs: all subjects take about a minute per pass on two cores.
    bool is_quick = false;
    /// The rounds of each time in all passes together; each pass has its own warm-up.
    Repeats repeats{10, 1};
    /// The number of passes over all experiments: at least 1, and at most the number of rounds.
    /// Without times there is one pass. The rounds of an experiment are interleaved, but may all
    /// lie within a busy second of the machine. Passes spread them over the whole run, so that the
    /// median ignores such a second.
    std::size_t passes = 1;
    /// If false, only errors are computed. They are the same on every machine, except for those of
    /// pictures drawn by OpenGL.
    bool is_timed = true;
    /// The number of threads for "all threads"; 0: the number of hardware threads.
    unsigned threads = 0;
    /// Selects experiments by Experiment::id. What is left out is not run. Empty: all.
    std::function<bool(const std::string& id)> selects_experiment{};
    /// Called before each experiment of each pass. May throw Cancelled.
    std::function<void(const RunProgress& progress)> tell{};
    /// Called with each experiment as soon as it is complete, in the last pass.
    std::function<void(Experiment& experiment)> finished{};
};

/// The costs that are measured.
struct CostChoice {
    bool one_thread = true;
    bool all_threads = true;
    bool memory = true;
};

/// Measured times within this factor of each other are ties: the position of code and data in
/// memory can change a time as much.
inline constexpr double equal_time_ratio = 1.1;

/// The median of ratios and its 95 % confidence interval.
struct RatioInterval {
    double median = 1.0;
    double low = 1.0;
    double high = 1.0;
};

/// Computes the confidence interval of a median from order statistics, without assumptions on the
/// distribution. For fewer than 6 values it is their whole range.
/// \param values  not empty
RatioInterval median_interval(std::vector<double> values);

/// The error and time of a method, in any unit; smaller is better. NaN means unknown.
struct MethodCost {
    double error = 0.0;
    double time = 0.0;
    /// The time of each round, interleaved with those of the other methods. Empty: `time` is exact.
    std::vector<double> rounds{};
};

/// Finds the Pareto-optimal methods.
///
/// Measured times are compared by the ratios of their rounds, because what slows one method down
/// for a moment slows down the next one, too. A method is faster if the interval of these ratios
/// lies beyond equal_time_ratio; else the times are tied.
///
/// \return for each method, true if it is faster than each Pareto-optimal method that is more
///         accurate, and not slower than those with the same error. A method with NaN is never
///         Pareto-optimal and does not affect the others
std::vector<bool> pareto_optimal(std::span<const MethodCost> costs);

/// Marks the measurements that are pareto_optimal() by RMS error and time on one thread, or on all
/// threads if only that was measured. Without times none is marked. Measurements with undefined
/// results are never marked.
void mark_pareto_optimal(Experiment& experiment);

/// Computes the slope of log(error) over log(x) by least squares, from the points whose coordinates
/// are positive and finite.
/// \return nothing for fewer than two different x
std::optional<double> fitted_order(const std::vector<CurvePoint>& points);

/// Returns true if some of its experiments draw with OpenGL, so that their errors depend on the
/// renderer.
bool uses_opengl(Subject subject);

/// Returns the subject of this name. \throws InvalidInput listing the valid names
Subject subject_from(std::string_view word);

/// Formats a time: "840 ns", "4.13 µs", "12.3 ms", "1.50 s".
std::string format_seconds(double seconds);

/// Runs the experiments of some subjects.
///
/// Each experiment prepares its input once. Each pass measures all experiments, the methods of each
/// interleaved (A B C A B C ...). Times on one thread are CPU times, so that other programs do not
/// add to them; times on all threads are wall-clock times. Memory is the peak resident memory of
/// the process according to Linux minus the resident memory before, in whole pages;
/// what other threads allocate meanwhile is included.
///
/// \param subjects  in the order of the results
/// \return the results with the rounds of all passes. Exceptions of experiments pass through
std::vector<Experiment> run_experiments(std::span<const Subject> subjects,
                                        const RunOptions& options);

// Comparison of two runs of the same experiments.

/// Times of two runs within this factor of each other are ties: equal runs differ by as much,
/// because other programs slow down one of them.
inline constexpr double equal_run_ratio = 1.15;

/// The times of a new run relative to an old one. The time of a method is its fastest round,
/// because other programs only add time.
struct TimeRatio {
    std::optional<Subject> subject{};  ///< Absent: all methods.
    bool on_all_threads = false;
    std::size_t methods = 0;  ///< At least 6.
    RatioInterval ratio{};    ///< Of the new time to the old time, over the methods.

    /// The whole interval is beyond a ratio, and beyond a tie.
    [[nodiscard]] bool is_slower(double limit = equal_run_ratio) const {
        return ratio.low > std::max(limit, equal_run_ratio);
    }
    [[nodiscard]] bool is_faster() const { return ratio.high < 1.0 / equal_run_ratio; }
};

/// One figure. NaN means that there is no usable result.
struct FigureChange {
    std::string figure;  ///< "rms", "mean", "p99", "max", "undefined"; for curves "at X"; "memory".
    double before = 0.0;
    double after = 0.0;

    /// after / before - 1: 0.1 for an increase by a tenth. Infinite if a usable result became
    /// undefined or zero became positive; -1 in the opposite cases.
    [[nodiscard]] double growth() const;
};

/// The figures of one method, or of one of its curves, that differ.
struct MethodChange {
    std::string experiment;
    std::string chart;  ///< Empty for the measurement itself.
    std::string method;
    std::vector<FigureChange> figures;  ///< Not empty.

    /// "EXPERIMENT: METHOD", "EXPERIMENT, chart ID: METHOD"
    [[nodiscard]] std::string name() const;
    /// The figure with the largest growth.
    [[nodiscard]] const FigureChange& worst() const;
};

struct ReportComparison {
    std::size_t methods = 0;       ///< Number of methods that occur in both reports.
    std::size_t with_memory = 0;   ///< Number of these methods with known memory in both.
    std::vector<TimeRatio> times;  ///< Of all methods, and of each subject if there are several.
    /// Errors are the same in each run. A difference counts if it exceeds rounding.
    std::vector<MethodChange> errors;
    /// Peak memory in bytes. A difference counts if it is at least a tenth and a megabyte; smaller
    /// ones result from page granularity and the timing of threads.
    std::vector<MethodChange> memory;
    /// Only in the old report: MethodChange::name(), with " at X" for a point of a curve.
    std::vector<std::string> gone;
    std::vector<std::string> added;        ///< Only in the new report.
    std::vector<std::string> other_input;  ///< Experiments whose input differs.
};

/// Compares two reports.
ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after);

}  // namespace accuracy
}  // namespace relief
