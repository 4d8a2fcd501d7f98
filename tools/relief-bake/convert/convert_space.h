// SPDX-License-Identifier: Apache-2.0
/// \file
/// `relief-bake convert --to-object MESH` and `--to-tangent MESH`: steps between the spaces of a
/// mesh. Tests: tests/tools/relief_bake_space_test.cpp.
#pragma once

#include <filesystem>
#include <optional>

#include "common/command.h"
#include "relief/mesh/frames.h"

namespace relief::tools {

struct ConvertStep;

/// What lies beyond the unit square of texture coordinates.
enum class UvOutside { ignore, repeat };

/// Which mesh, and how the map lies on it.
struct SpaceConversion {
    std::optional<std::filesystem::path> to_object;
    std::optional<std::filesystem::path> to_tangent;
    std::optional<TangentMode> tangents;
    std::optional<UvOutside> outside;
    std::optional<int> udim;  ///< 1001 and on.
};

void add_space_options(CLI::App& app, SpaceConversion& choice);

/// \throws UsageError where options contradict each other, or one has no effect without another
void check_space_options(const SpaceConversion& choice);

/// \throws FileError when applied, if the mesh cannot be read or has no texture coordinates
ConvertStep to_object_step(const SpaceConversion& choice);
ConvertStep to_tangent_step(const SpaceConversion& choice);

}  // namespace relief::tools
