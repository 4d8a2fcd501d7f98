// SPDX-License-Identifier: Apache-2.0
/// \file
/// The commands that remedy conditions of normal maps, for `relief-bake check` and `relief check`.
/// Tests: tests/tools/relief_bake_check_test.cpp, tests/check/check_fix_test.cpp.
#pragma once

#include <string>
#include <string_view>

#include "relief/mesh/normal_map_check.h"

namespace relief::tools {

/// Returns the command that remedies a condition, with the words IN and OUT for the files; empty if
/// no command can, or if it needs more than the map.
constexpr std::string_view map_remedy(MapCondition condition) {
    switch (condition) {
        case MapCondition::z_missing:
        case MapCondition::z_constant:
            return "relief-bake convert IN OUT --rebuild-z rg";
        case MapCondition::signed_samples:
            return "relief-bake convert IN OUT --input-signed";
        case MapCondition::tagged_as_color:
            return "relief-bake convert IN OUT";
        case MapCondition::texel_not_finite:
        case MapCondition::texel_without_direction:
        case MapCondition::not_unit:
        case MapCondition::not_quite_unit:
            return "relief-bake convert IN OUT --normalize";
        case MapCondition::green_contradicted:
        case MapCondition::green_down:
            return "relief-bake convert IN OUT --flip green";
        case MapCondition::flat_contradicted:
            return "relief-bake convert IN OUT --input-zero-code 127.5";
        case MapCondition::bits_unused:
            return "relief-bake convert IN OUT --bits 8";
        case MapCondition::alpha_opaque:
            return "relief-bake convert IN OUT --alpha drop";
        default:
            return "";
    }
}

/// Returns a command with the names of the files.
std::string with_files(std::string_view command, const std::string& input,
                       const std::string& output);

}  // namespace relief::tools
