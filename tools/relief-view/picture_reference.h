// SPDX-License-Identifier: Apache-2.0
/// \file
/// The drawn picture against one that is known to be right: --reference, --max-difference and
/// --difference-map. Tests: tests/tools/picture_reference_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "relief/shade/image_compare.h"
#include "view_options.h"

namespace relief::tools {

void add_reference_options(CLI::App& app, ViewOptions& options);

/// \throws UsageError if one of them says nothing without another, or would overwrite a file that
///         the command works on; FileError if the map's folder does not exist
void check_reference(const ViewOptions& options);

/// The picture to compare with. \throws FileError if it cannot be read, or is not of --size, which
/// is so known before anything is drawn
Image read_reference(const ViewOptions& options);

/// How far the drawn picture is from the reference.
struct ReferenceComparison {
    ImageDifference difference;
    FlipDifference flip;
    double allowed = 0;  ///< --max-difference
    double peak = 1;     ///< What the largest sample stands for: 255, 65535 or 1.

    [[nodiscard]] bool matches() const { return difference.max <= allowed; }
};

/// Compares, and writes the map if one is asked for. A picture without alpha covers everything.
/// \throws FileError if the two do not have the same bits and channels, or the map cannot be
///         written
ReferenceComparison compare_with_reference(const ViewOptions& options, const Image& picture,
                                           const Image& reference);

/// "largest 3 of 255, mean 0.02, PSNR 58.1 dB, FLIP 0.004 (largest 0.21), 812 pixels differ"
std::string in_words(const ReferenceComparison& comparison);

/// Numbers without bound (PSNR of equal pictures) are null.
nlohmann::ordered_json comparison_json(const ViewOptions& options,
                                       const ReferenceComparison& comparison);

/// \throws FileError, and so ends with exit code 1, if the pictures do not match
void require_match(const ViewOptions& options, const ReferenceComparison& comparison);

}  // namespace relief::tools
