// SPDX-License-Identifier: Apache-2.0
/// \file
/// A small report with all optional parts.
#pragma once

#include "accuracy_report.h"

namespace relief::test {

/// One experiment of two methods, "storage/sample": "exact, slow" (1 ms) and "near" (0.5 ms, RMS
/// 0.25), with a chart, a heat map and a pair of pictures. All values are invented.
tools::AccuracyReport sample_report();

}  // namespace relief::test
