// SPDX-License-Identifier: Apache-2.0
/// \file
/// Recommends a method of an experiment, and states the cost of the next more accurate one.
/// Tests: tests/accuracy/asset_report_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "relief/accuracy/experiment.h"
#include "relief/export.h"

namespace RELIEF_API relief {

/// The cost to minimize: time (Measurement::cost, on one thread if that was measured), or the
/// stored bytes of each item.
enum class CostKind { time, bytes };

/// The limits of a request. Without limits, the knee is recommended, see recommended().
struct MethodRequest {
    /// In the unit of the experiment, for the statistic `figure`.
    std::optional<double> max_error;
    std::optional<double> max_seconds;  ///< Maximum time in seconds; ignored for CostKind::bytes.
    double ErrorFigures::*figure = &ErrorFigures::rms;  ///< The statistic that `max_error` limits.
};

struct RecommendationRule {
    MethodRequest request;
    CostKind cost = CostKind::time;
    /// An invisible error. The search for the knee adds its square to that of each error.
    double negligible_error = 0.0;
    /// For each measurement, whether it may be recommended; empty: all.
    std::span<const unsigned char> choosable;
    /// For each measurement, a cost that does not depend on measured time (such as operations per
    /// texel). It decides between methods of equal size if nothing was timed. Empty: unknown.
    std::span<const double> nominal_costs;
    /// The name of the source of Experiment::reference_error, such as "the map itself".
    std::string reference = "the reference itself";
};

struct Recommendation {
    /// Index of the measurement; absent if none is within the limits.
    std::optional<std::size_t> method;
    /// The next more accurate method that is Pareto-optimal among those that may be recommended.
    std::optional<std::size_t> next;
    /// "scharr3, float32, 16 bit: 0.05 degrees RMS at 41.0 ms; the next more accurate (...) takes 3
    /// times as long for 0.01 degrees less". Or the method closest to the request.
    std::string words;
};

/// Recommends a method. Its error is the root of the sum of squares of Experiment::reference_error
/// and the error that the method adds.
///
/// - With `max_error`: the cheapest method whose error is within it (and whose time is within
///   max_seconds, if given). If nothing was timed, the one with the fewest stored bytes, then the
///   one with the smallest natural cost.
/// - With `max_seconds` alone: the most accurate method within it.
/// - Without both, the knee: the Pareto-optimal method with the smallest error^3 x cost, so that
///   half the error is worth eight times the cost. Among the methods within a tenth of this
///   minimum, because times are not more accurate, the one with the fewest stored bytes. If nothing
///   was timed, the most accurate one.
///
/// Measurements with undefined results are never recommended. Ties: the first method wins.
Recommendation recommended(const Experiment& experiment, const RecommendationRule& rule);

}  // namespace relief
