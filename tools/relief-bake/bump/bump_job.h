// SPDX-License-Identifier: Apache-2.0
/// \file
/// One height map to one normal map, from file to file.
/// Tests: tests/tools/relief_bake_test.cpp.
#pragma once

#include <optional>

#include "bump/bump_options.h"
#include "common/file_jobs.h"
#include "common/findings.h"

namespace relief::tools {

/// What was made of which image.
struct Baked {
    ImageInfo input;
    bool is_streamed = false;      ///< Read by rows, since it is large.
    std::size_t transparent = 0;   ///< Texels that are no part of the surface.
    BumpOptions bump;              ///< With what was found out from the map.
    std::optional<Tiling> tiling;  ///< If it was looked at.
    AccuracyFound accuracy;
    BumpFileFormat format;
    Findings findings;
};

/// Reads, converts and writes; the stages are "read", "look" where the map decides something,
/// "convert" and "write".
/// \throws FileError, UsageError
Baked bake_bump(const Job& job, const BumpRequest& request, Stages& stages);

}  // namespace relief::tools
