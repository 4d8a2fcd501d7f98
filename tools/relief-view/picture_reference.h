// SPDX-License-Identifier: Apache-2.0
/// \file
/// The drawn picture against one that is known to be right: --reference, --max-difference and
/// --difference-map. Tests: tests/tools/picture_reference_test.cpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "picture_comparison.h"
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
struct ReferenceComparison : PictureComparison {
    double allowed = 0;  ///< --max-difference

    [[nodiscard]] bool matches() const { return difference.max <= allowed; }
};

/// Compares, and writes the map if one is asked for. A picture without alpha covers everything.
/// \throws FileError if the two do not have the same bits and channels, or the map cannot be
///         written
ReferenceComparison compare_with_reference(const ViewOptions& options, const Image& picture,
                                           const Image& reference);

/// Writes --difference-map, where one is asked for. \throws FileError
void write_difference_map(const ViewOptions& options, const PictureComparison& comparison);

nlohmann::ordered_json comparison_json(const ViewOptions& options,
                                       const ReferenceComparison& comparison);

/// \throws FileError, and so ends with exit code 1, if the pictures do not match
void require_match(const ViewOptions& options, const ReferenceComparison& comparison);

}  // namespace relief::tools
