// SPDX-License-Identifier: Apache-2.0
/// \file
/// One normal map to one height map, from file to file, and how it is told.
/// Tests: tests/tools/relief_bake_heights_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/file_jobs.h"
#include "common/findings.h"
#include "heights/heights_options.h"

namespace relief::tools {

/// What was made of which map.
struct MadeHeights {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits_read = 0;
    std::string input_words;
    Green green = Green::up;
    bool green_by_slopes = false;
    IntegrationOptions integration;
    IntegratedHeights result;  ///< Without the heights themselves.
    int bits = 16;
    double strength = 1.0;  ///< Texels that the stored value 1.0 stands for.
    Findings findings;
};

/// Reads, integrates and writes; the stages are "read", "integrate" and "write".
/// \throws FileError, UsageError
MadeHeights make_heights(const Job& job, const HeightsRequest& request, Stages& stages);

void print_summary(const Job& job, const MadeHeights& made, const Stages& stages);
std::string line_of(const Job& job, const MadeHeights& made, const Stages& stages);
nlohmann::ordered_json results_json(const MadeHeights& made, const Stages& stages);

}  // namespace relief::tools
