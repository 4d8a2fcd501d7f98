// SPDX-License-Identifier: Apache-2.0
/// \file
/// What became faster or slower, more or less exact, between two runs of the same experiments.
///
/// *Errors* are the same in each run: whatever differs by more than rounding is a change.
///
/// *Times* are not. What counts is the ratio of the medians of the rounds, where it lies outside of
/// what two runs of one program may differ by:
/// - a method by the scatter of the ratios of all methods, which shows how far equal runs differ,
///   and by its own rounds, of which the middle 80 % must not overlap; the bound widens with the
///   number of methods, so that in 95 of 100 comparisons of equal runs none is reported;
/// - all methods together by the machine's drift, which the parts of each run show.
/// A method counts as measured and relative to the median of all methods as well: a machine that
/// was slower changes all alike. The smaller of the two is reported. From one machine to another
/// only the second counts.
///
/// Where a bound is given that is closer than the times can resolve, the verdict is cannot_tell:
/// nothing proves that the bound is kept. Load that lasts for one whole run and not for the other
/// looks like a change of all methods.
/// Tests: tests/accuracy/compare_reports_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"

namespace relief {

enum class TimeVerdict {
    unchanged,  ///< No change beyond what equal runs differ by.
    slower,
    faster,
    cannot_tell,  ///< No change is seen, but one beyond the bound would not be seen either.
};

/// A ratio and the range that two runs of one program leave open.
struct Interval {
    double value = 1.0;
    double low = 1.0;
    double high = 1.0;
};

/// How the time of one method changed.
struct TimeChange {
    std::string experiment;
    std::string method;
    bool on_all_threads = false;
    double before = 0.0;  ///< Medians, in seconds.
    double after = 0.0;
    Interval ratio;           ///< Of the medians, as measured: more than 1 is slower.
    double relative = 1.0;    ///< The same, divided by the median ratio of all methods.
    double counted = 1.0;     ///< The ratio that is judged.
    double resolution = 1.0;  ///< Ratios between 1 / this and this may be chance.
    TimeVerdict verdict = TimeVerdict::unchanged;
};

/// The change that all methods share, on one thread or on all threads.
struct CommonChange {
    std::size_t methods = 0;
    Interval ratio;           ///< The median ratio of all methods.
    double scatter = 0.0;     ///< Of the logarithms of their ratios around it, as a deviation.
    double reach = 0.0;       ///< How far from it chance takes a single one, in logarithms.
    double drift = 0.0;       ///< Standard error of its logarithm by the drift within the runs.
    double resolution = 1.0;  ///< Ratios between 1 / this and this may be chance.
    bool is_judged = false;   ///< There were enough methods to know the median and the scatter.
    TimeVerdict verdict = TimeVerdict::unchanged;
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
/// \param max_ratio     a bound of how many times as long methods may take; where chance may be
///                      larger, verdicts are cannot_tell. Absent: there is none
ReportComparison compare_reports(const std::vector<Experiment>& before,
                                 const std::vector<Experiment>& after, bool same_machine,
                                 const std::optional<double>& max_ratio = {});

}  // namespace relief
