// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of the methods of an experiment to take, and what the next more accurate one would cost.
/// Tests: tests/accuracy/recommend_test.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "relief/accuracy/experiment.h"

namespace relief {

/// What is dear: time (Measurement::cost, on one thread where that was measured), or the bytes that
/// are stored of each thing.
enum class CostKind { time, bytes };

/// What somebody asks of a method; neither: the knee, see recommended().
struct Wish {
    std::optional<double> max_error;    ///< In the unit of the experiment, of `figure`.
    std::optional<double> max_seconds;  ///< Time, or with CostKind::bytes of no effect.
    double ErrorFigures::*figure = &ErrorFigures::rms;  ///< Which error `max_error` is for.
};

struct RecommendationRule {
    Wish wish;
    CostKind cost = CostKind::time;
    /// An error that nobody sees. The knee adds it to each error, as squares.
    double unseen_error = 0.0;
    /// For each measurement, whether it may be recommended; empty: all.
    std::span<const unsigned char> choosable;
    /// For each measurement, what it costs by its own nature (such as operations a texel); it
    /// decides between methods of equal size where nothing was timed. Empty: unknown.
    std::span<const double> natural_costs;
    /// Names the source of Experiment::reference_error, such as "the map itself".
    std::string reference = "the reference itself";
};

struct Recommendation {
    std::optional<std::size_t> method;  ///< Of the measurements; absent: none is within the limits.
    /// The next more accurate one that is efficient among those that may be recommended.
    std::optional<std::size_t> next;
    /// "scharr3, float32, 16 bit: 0.05 degrees RMS at 41.0 ms; the next more accurate (...) takes 3
    /// times as long for 0.01 degrees less". Or what comes closest to the request.
    std::string words;
};

/// The method to take. The error that counts is Experiment::reference_error and what the method
/// adds, as the root of the sum of squares.
///
/// - With `max_error`: the cheapest whose error is within it (and its time within max_seconds, if
///   that is given). Where nothing was timed, the one that stores the fewest bytes; of these the
///   one of least natural cost.
/// - With `max_seconds` alone: the most accurate of those within it.
/// - With neither, the knee: of the efficient ones that of the least error^3 x cost, so that half
///   the error is worth eight times the cost. Of those within a tenth of that, as times are hardly
///   known better, the one that stores the fewest bytes. Where nothing was timed, the most
///   accurate.
///
/// Measurements with undefined results are never taken. Ties: the first method wins.
Recommendation recommended(const Experiment& experiment, const RecommendationRule& rule);

}  // namespace relief
