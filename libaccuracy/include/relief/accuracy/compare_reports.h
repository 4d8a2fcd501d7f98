// SPDX-License-Identifier: Apache-2.0
/// \file
/// Compares two runs of the same experiments: times, errors and memory.
///
/// *Errors* are the same in each run, so every difference beyond rounding is a change.
///
/// *Times* are not. They are judged by the ratios of the two runs, one for each method:
/// - The time of a method is its fastest round, because other programs only add time.
/// - The ratio of a method is its new time divided by its old time.
/// - The common ratio is the median of the ratios of all methods. It contains the machine.
/// - The resolution of all methods is 1 + 12 times the interquartile range of these ratios,
///   relative to their lower quartile. That of one method is this number multiplied by its median
///   round divided by its fastest round. Both are at least 1.1.
/// - A method is slower or faster if its ratio is beyond the resolution, both as measured and
///   divided by the common ratio; the smaller of the two changes is reported. Between different
///   machines only the divided ratio is judged.
/// - All methods together are slower or faster if the common ratio is beyond their resolution.
///
/// If a bound is given and the resolution is coarser than the bound, the verdict is cannot_tell,
/// because the times do not prove that the bound is kept. With fewer than 8 methods the
/// interquartile range is unknown, so no time is judged. If more than a quarter of the methods
/// change by another ratio than the others, the range contains the change, and the resolution is
/// coarse. A load that lasts for one whole run and is absent from the other looks like a change of
/// all methods.
/// Tests: tests/accuracy/compare_reports_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relief/accuracy/experiment.h"
#include "relief/export.h"

namespace RELIEF_API relief {

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
