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
///
/// What this cannot see: a busy moment of the machine as long as all rounds of an experiment looks
/// like a change of its methods. Passes spread them (passes.h).
/// Tests: tests/accuracy/compare_reports_test.cpp.
#pragma once

#include <cstdint>
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

/// What a method holds at the most, where that is more or less by at least a tenth and a megabyte:
/// pages, and what threads happen to hold at one time, make less than that.
struct MemoryChange {
    std::string experiment;
    std::string method;
    std::uint64_t before = 0;  ///< Bytes.
    std::uint64_t after = 0;

    /// After by before, less 1.
    [[nodiscard]] double growth() const;
};

struct ReportComparison {
    std::size_t methods = 0;      ///< In both.
    std::size_t with_memory = 0;  ///< Of those, whose memory both know.
    std::vector<MemoryChange> memory;
    std::vector<TimeChange> times;
    CommonChange one_thread;
    CommonChange all_threads;
    std::vector<ErrorChange> errors;
    /// Only in the old one: "EXPERIMENT: METHOD", "EXPERIMENT, chart ID: METHOD", " at X" for a
    /// point of a curve.
    std::vector<std::string> gone;
    std::vector<std::string> added;        ///< Only in the new one.
    std::vector<std::string> other_input;  ///< Experiments on something else than before.
};

/// \param same_machine  whether times may be compared as measured
ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after, bool same_machine);

}  // namespace relief
