// SPDX-License-Identifier: Apache-2.0
/// \file
/// One height map to one normal map, from file to file.
/// Tests: tests/tools/relief_bake_test.cpp.
#pragma once

#include <optional>

#include "bump_options.h"
#include "common/file_jobs.h"
#include "common/findings.h"
#include "relief/mesh/height_statistics.h"

namespace relief::tools {

/// What was made of which image.
struct Baked {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits_read = 0;
    BumpOptions bump;              ///< With what was found out from the map.
    std::optional<Tiling> tiling;  ///< If it was looked at.
    NormalMapFormat format;
    Findings findings;
};

/// Reads, converts and writes; the stages are "read", "convert" and "write".
/// \throws FileError, UsageError
Baked bake_bump(const Job& job, const BumpRequest& request, Stages& stages);

}  // namespace relief::tools
