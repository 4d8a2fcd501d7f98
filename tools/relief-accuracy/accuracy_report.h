// SPDX-License-Identifier: Apache-2.0
/// \file
/// A whole report: what was asked for, on which machine, and what was found; from which all forms
/// of it are made, and which is read back to be compared. docs/accuracy-schema.md describes its
/// JSON. Tests: tests/tools/accuracy_report_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "machine.h"
#include "relief/accuracy/experiment.h"

namespace relief::tools {

/// The version of the JSON that is written, and the only one that is read.
inline constexpr int report_version = 1;

/// How a report came about.
struct RunSettings {
    bool quick = false;
    bool timed = true;
    std::size_t repeats = 0;  ///< Of all passes together.
    std::size_t passes = 1;
    unsigned threads = 0;  ///< That "all threads" were.
};

struct AccuracyReport {
    std::string relief;   ///< Its version.
    std::string command;  ///< That repeats it.
    Machine machine;
    RunSettings settings;
    std::vector<Experiment> experiments;
};

}  // namespace relief::tools
