// SPDX-License-Identifier: Apache-2.0
/// \file
/// What an experiment on accuracy found: methods on one input, each with its error from a ground
/// truth and what it cost. Plain data, from which every report is made (tables, JSON, CSV, HTML).
/// Tests: tests/accuracy/experiment_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/image.h"
#include "relief/mesh/kernel_choice.h"
#include "relief/mesh/timing.h"

namespace relief {

class EarlierPasses;  // passes.h

/// What experiments are about; the words of `relief-accuracy run`.
enum class Subject { normals, tangents, bump, storage, bake, shading, stability };

/// Errors of many directions, pixels or other things, all in the unit of their experiment.
struct ErrorFigures {
    std::size_t count = 0;      ///< That have a number.
    std::size_t undefined = 0;  ///< That have none: NaN, or a direction of no length.
    double rms = 0.0;           ///< Root of the mean square; NaN, as all others, where count is 0.
    double mean = 0.0;
    double p99 = 0.0;  ///< 99 of 100 are no larger.
    double max = 0.0;
    std::optional<double> psnr{};  ///< Of pictures, in decibels: 20 log10(peak / rms).

    friend bool operator==(const ErrorFigures&, const ErrorFigures&) = default;
};

/// The one way from any summary of angles to figures; of none, NaN.
ErrorFigures figures_of(const AngleDistribution& angles);
ErrorFigures figures_of(const AngleSummary& angles);

/// What a curve shows (CurvePoint::error): the RMS; NaN where there is none, or where a single
/// result is undefined, which must not vanish in a mean.
double curve_error(const ErrorFigures& error);
double curve_error(const AngleDistribution& angles);

/// Seconds of each counted repeat, in the order in which they were taken; in turns with the other
/// methods of the experiment, so that round i of all was taken at one time.
struct Timing {
    std::vector<double> rounds{};

    [[nodiscard]] Spread spread() const { return spread_of(rounds); }
    friend bool operator==(const Timing&, const Timing&) = default;
};

/// What a method takes; absent: not measured, or the method has no such thing.
struct Cost {
    std::optional<Timing> one_thread{};
    std::optional<Timing> all_threads{};
    /// The most memory that it held at a time, beyond what there was before.
    std::optional<std::uint64_t> peak_bytes{};
    /// Of what it makes: a vertex's frame, a texel. 0: of no interest.
    double stored_bytes = 0.0;

    friend bool operator==(const Cost&, const Cost&) = default;
};

/// One method on the experiment's input.
struct Measurement {
    std::string method{};  ///< Unique in its experiment, the same in every run: "max, float64".
    /// What can be chosen, and what is: {"weighting", "max"}, {"arithmetic", "float64"}.
    std::vector<std::pair<std::string, std::string>> choices{};
    ErrorFigures error{};
    Cost cost{};
    /// Both parts of the error, if the reference has an error (Experiment::reference_error).
    std::optional<ExpectedError> expected{};
    bool is_efficient = false;  ///< On the frontier of RMS error against time (mark_efficient()).
    std::string note{};         ///< What a reader ought to know of it; mostly empty.
};

/// Error along something that varies: cells of a mesh, texels of a wave, the scale of a mesh.
struct CurvePoint {
    double x = 0.0;
    double error = 0.0;  ///< RMS, in the unit of the experiment; NaN: no usable result.
};
struct Curve {
    std::string method{};
    std::vector<CurvePoint> points{};        ///< By growing x.
    std::optional<double> order{};           ///< The slope fitted on log axes (fitted_order()).
    std::optional<double> expected_order{};  ///< By theory.
    std::optional<double> breaks_at{};  ///< The first x with an error beyond the chart's bound.
};
struct Chart {
    std::string id{};  ///< Unique in its experiment.
    std::string title{};
    std::string x_label{};  ///< With its unit.
    std::string y_label{};
    bool is_x_log = true;
    std::optional<double> bound{};  ///< An error beyond it is a failure.
    std::vector<Curve> curves{};
};

/// Errors over a map or picture: one float channel, in the unit of the experiment.
struct HeatMap {
    std::string title{};
    std::string method{};
    Image errors{};
    double brightest = 1.0;
};

/// Two pictures to lay a line between.
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
    std::string question{};  ///< One sentence that ends with a question mark.
    std::string truth{};     ///< What errors are counted from, and how that is known.
    /// The error that this reference itself is expected to have, RMS; absent: none, or unknown.
    std::optional<double> reference_error{};
    std::string input{};       ///< "torus, jittered, 64 x 64 cells: 8192 triangles"
    std::string error_unit{};  ///< "degrees", "FLIP"
    std::string item{};        ///< What work is counted in: "triangle", "texel", "pixel"
    double items = 0.0;
    /// What repeats it: "relief-accuracy run normals"; filled in by the tool.
    std::string command{};
    std::vector<Measurement> measurements{};
    std::vector<Chart> charts{};
    std::vector<HeatMap> heat_maps{};
    std::vector<PicturePair> pictures{};
    /// What follows, in a sentence or two that name numbers; made from the measurements.
    std::string finding{};
    /// Problems and doubts about the input and how they were handled, one sentence each.
    std::vector<std::string> input_findings{};
};

/// How thoroughly experiments are run.
struct RunOptions {
    /// Small inputs: all subjects in about a minute for each pass, on two cores.
    bool is_quick = false;
    Repeats repeats{10, 1};
    /// False: errors alone, which are the same on every machine but for what OpenGL draws.
    bool is_timed = true;
    /// How many threads "all threads" are; 0: as many as the machine has.
    unsigned threads = 0;
    /// The rounds of earlier passes, filled in by run_in_passes(); null: there is one pass.
    std::shared_ptr<EarlierPasses> earlier{};
    /// Before each experiment: its title, and how many are done of how many. May throw Cancelled.
    std::function<void(const std::string& title, std::size_t done, std::size_t total)> tell{};
};

/// Marks the measurements that are efficient by RMS error and time on one thread; on all threads
/// where that is all there is. Where nothing was timed, none is. Measurements with undefined
/// results are never efficient.
void mark_efficient(Experiment& experiment);

/// The slope of log(error) over log(x) by least squares, over points with both positive and finite.
/// \return nothing for fewer than two different x
std::optional<double> fitted_order(const std::vector<CurvePoint>& points);

/// The experiments of one subject.
std::vector<Experiment> run_experiments(Subject subject, const RunOptions& options);

}  // namespace relief
