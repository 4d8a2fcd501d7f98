// SPDX-License-Identifier: Apache-2.0
/// \file
/// What became faster or slower, more or less exact, between two runs of the same experiments.
///
/// *Errors* come out the same in each run: whatever differs by more than rounding is a change.
/// *Times* do not. One counts as changed only if all of this holds:
/// - the rounds of both runs differ in rank, with at most 5 % of all that is found being chance
///   (two_samples.h);
/// - by at least 3 %, and by more than three times what the other methods' ratios scatter: two runs
///   of one program differ by how memory lies and what else the machine does, which the rounds of
///   one run do not show;
/// - as measured, and also relative to the middle of all methods: a machine that was slower changes
///   all alike. Of the two the lesser is told. From one machine to another only the second counts.
/// Tests: tests/accuracy/compare_reports_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/accuracy/two_samples.h"

namespace relief {

enum class TimeVerdict {
    unchanged,  ///< Nothing beyond chance.
    slower,
    faster,
    cannot_tell,  ///< Alone it would count; so few rounds cannot show it among so many methods.
};

/// How the time of one method changed.
struct TimeChange {
    std::string experiment;
    std::string method;
    bool on_all_threads = false;
    double before = 0.0;  ///< Medians, in seconds.
    double after = 0.0;
    Interval ratio;         ///< Of the medians, as measured: more than 1 is slower.
    double relative = 1.0;  ///< The same, divided by that of the middle of all.
    double counted = 1.0;   ///< What is judged.
    double p = 1.0;         ///< Of chance alone doing so, were there only this method.
    TimeVerdict verdict = TimeVerdict::unchanged;
};

/// What all methods have in common, on one thread or on all.
struct CommonChange {
    std::size_t methods = 0;
    Interval ratio;  ///< The middle of all; resampled by experiment, whose methods share much.
    double scatter = 0.0;    ///< Of the logarithms of single ones around it, as a deviation.
    double smallest = 1.0;   ///< Ratios between 1 / this and this do not count.
    bool is_judged = false;  ///< There were enough methods to know the middle and the scatter.
};

/// One figure of an error. NaN: no usable result.
struct FigureChange {
    std::string figure;  ///< "rms", "mean", "p99", "max", "undefined"; of a curve "at X".
    double before = 0.0;
    double after = 0.0;

    /// After by before, less 1: 0.1 for a tenth more. Infinite where a usable result became none,
    /// or zero something; -1 the other way.
    [[nodiscard]] double growth() const;
};

/// What changed about the error of one method, or about one of its curves.
struct ErrorChange {
    std::string experiment;
    std::string chart;  ///< Empty: the measurement.
    std::string method;
    std::vector<FigureChange> figures;  ///< Not empty.

    /// The one that grew most, or fell least.
    [[nodiscard]] const FigureChange& worst() const;
};

struct ReportComparison {
    std::size_t methods = 0;  ///< In both.
    std::vector<TimeChange> times;
    CommonChange one_thread;
    CommonChange all_threads;
    std::vector<ErrorChange> errors;
    std::vector<std::string> gone;         ///< "EXPERIMENT: METHOD", only in the old one.
    std::vector<std::string> added;        ///< Only in the new one.
    std::vector<std::string> other_input;  ///< Experiments on something else than before.
};

/// \param same_machine  whether times may be compared as measured
ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after, bool same_machine);

}  // namespace relief
