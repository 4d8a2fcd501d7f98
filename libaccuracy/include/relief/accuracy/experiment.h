// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines the results of accuracy experiments, and compares two runs of them. A result holds
/// methods on one input, each with its error against a ground truth and its cost. All reports are
/// written from this data (tables, JSON, CSV, HTML).
/// Tests: tests/accuracy/experiment_test.cpp, tests/accuracy/compare_reports_test.cpp.
#pragma once

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
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/statistics.h"

namespace RELIEF_API relief {

/// The subjects of experiments, with the names of `relief-accuracy run`.
enum class Subject {
    normals,
    tangents,
    bump,
    storage,
    compression,
    bake,
    decimation,
    shading,
    stability
};

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

/// Identifies a method within its experiment: a value of the experiment's own enumeration, or the
/// index of the method in the experiment's list. Reports do not contain it.
enum class MethodId : std::uint32_t {};

/// One method on the experiment's input.
struct Measurement {
    MethodId id{};
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
    /// Selects methods by Measurement::method. What is left out is not run. An experiment without
    /// all of its methods has no charts, pictures and finding. Empty: all.
    std::function<bool(const std::string& method)> selects_method{};
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

// Comparison of two runs of the same experiments: times, errors and memory.
//
// *Errors* are the same in each run, so every difference beyond rounding is a change.
//
// *Times* are not. They are judged by the ratios of the two runs, one for each method:
// - The time of a method is its fastest round, because other programs only add time.
// - The ratio of a method is its new time divided by its old time.
// - The common ratio is the median of the ratios of all methods. It contains the machine.
// - The resolution of all methods is 1 + 12 times the interquartile range of these ratios,
//   relative to their lower quartile. That of one method is this number multiplied by its median
//   round divided by its fastest round. Both are at least 1.1.
// - A method is slower or faster if its ratio is beyond the resolution, both as measured and
//   divided by the common ratio; the smaller of the two changes is reported. Between different
//   machines only the divided ratio is judged.
// - All methods together are slower or faster if the common ratio is beyond their resolution.
//
// If a bound is given and the resolution is coarser than the bound, the verdict is cannot_tell,
// because the times do not prove that the bound is kept. With fewer than 8 methods the
// interquartile range is unknown, so no time is judged. If more than a quarter of the methods
// change by another ratio than the others, the range contains the change, and the resolution is
// coarse. A load that lasts for one whole run and is absent from the other looks like a change of
// all methods.

enum class TimeVerdict {
    unchanged,  ///< No change beyond the resolution.
    slower,
    faster,
    cannot_tell,  ///< No change is seen, but one beyond the bound would not be seen either.
};

/// The change of one method's time. Ratios are new by old: more than 1 is slower.
struct TimeChange {
    std::string experiment;
    std::string method;
    bool on_all_threads = false;
    double before = 0.0;      ///< Fastest round, in seconds.
    double after = 0.0;       ///< The same of the new run.
    double ratio = 1.0;       ///< As measured.
    double relative = 1.0;    ///< Divided by the median ratio of all methods.
    double counted = 1.0;     ///< The ratio that is judged.
    double resolution = 1.0;  ///< Ratios from 1 / this to this may be chance.
    TimeVerdict verdict = TimeVerdict::unchanged;
};

/// The ratios of all methods, on one thread or on all threads.
struct CommonChange {
    std::size_t methods = 0;
    double ratio = 1.0;           ///< Median.
    double lower_quartile = 1.0;  ///< A quarter of the ratios is below this.
    double upper_quartile = 1.0;  ///< A quarter of the ratios is above this.
    double resolution = 1.0;      ///< Ratios from 1 / this to this may be chance.
    bool is_judged = false;       ///< There are at least 8 methods.
    TimeVerdict verdict = TimeVerdict::unchanged;
};

/// One statistic of an error. NaN means that there is no usable result.
struct FigureChange {
    std::string figure;  ///< "rms", "mean", "p99", "max", "undefined"; for curves "at X".
    double before = 0.0;
    double after = 0.0;

    /// after / before - 1: 0.1 for an increase by a tenth. Infinite if a usable result became
    /// undefined or zero became positive; -1 in the opposite cases.
    [[nodiscard]] double growth() const;
};

/// The change of the error of one method, or of one of its curves.
struct ErrorChange {
    std::string experiment;
    std::string chart;  ///< Empty for the measurement itself.
    std::string method;
    std::vector<FigureChange> figures;  ///< Not empty.

    /// The figure with the largest growth.
    [[nodiscard]] const FigureChange& worst() const;
};

/// The change of the peak memory of a method, if it is at least a tenth and a megabyte. Smaller
/// changes result from page granularity and the timing of threads.
struct MemoryChange {
    std::string experiment;
    std::string method;
    std::uint64_t before = 0;  ///< In bytes.
    std::uint64_t after = 0;

    /// after / before - 1.
    [[nodiscard]] double growth() const;
};

struct ReportComparison {
    std::size_t methods = 0;      ///< Number of methods that occur in both reports.
    std::size_t with_memory = 0;  ///< Number of these methods with known memory in both.
    std::vector<MemoryChange> memory;
    std::vector<TimeChange> times;
    CommonChange one_thread;
    CommonChange all_threads;
    std::vector<ErrorChange> errors;
    /// Only in the old report: "EXPERIMENT: METHOD", "EXPERIMENT, chart ID: METHOD", " at X" for a
    /// point of a curve.
    std::vector<std::string> gone;
    std::vector<std::string> added;        ///< Only in the new report.
    std::vector<std::string> other_input;  ///< Experiments whose input differs.
};

/// Compares two reports.
///
/// \param same_machine  true if measured times may be compared directly
/// \param max_ratio  the maximum acceptable time ratio of a method; if the resolution is coarser,
///         verdicts are cannot_tell. Absent: there is none
ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after, bool same_machine,
                                 const std::optional<double>& max_ratio = {});

}  // namespace relief
