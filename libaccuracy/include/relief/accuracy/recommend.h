// SPDX-License-Identifier: Apache-2.0
/// \file
/// Which of the methods of an experiment to take, and what the next better one would cost.
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
    /// What errors are not known better than, or nobody sees: it is added to each, as squares.
    double own_error = 0.0;
    /// For each measurement, whether it may be taken; empty: all.
    std::span<const unsigned char> choosable;
};

struct Recommendation {
    std::optional<std::size_t> method;  ///< Of the measurements; absent: none keeps the wish.
    /// The next truer one that is efficient among those that may be taken; absent: none is truer.
    std::optional<std::size_t> next;
    /// "scharr3, float32, 16 bit: 0.05 degrees RMS at 41.0 ms; the next better (...) takes 3 times
    /// as long for 0.01 degrees less". Or what comes closest to the wish.
    std::string words;
};

/// The method to take.
///
/// - With `max_error`: the cheapest that keeps within it (and within max_seconds, if told).
/// - With `max_seconds` alone: the truest that keeps within it.
/// - With neither, the knee: of the efficient ones that of the least error^3 x cost, so that a
/// truer
///   one is worth up to as many times the cost as the cube of how many times it errs less. 1.25
///   times less error is worth twice the cost, half the error eight times. Of those within a tenth
///   of that, as times are hardly known better, the one that stores the fewest bytes.
///
/// Measurements with undefined results are never taken. Of equal ones the first is. Where nothing
/// was timed, all cost the same: the truest is taken.
Recommendation recommended(const Experiment& experiment, const RecommendationRule& rule);

}  // namespace relief
