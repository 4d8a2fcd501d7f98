// SPDX-License-Identifier: Apache-2.0
/// \file
/// The health of one image that should be a normal map, and how relief-bake check says it.
/// Tests: tests/tools/relief_bake_check_test.cpp.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "relief/mesh/normal_map_check.h"

namespace relief::tools {

struct CheckedMap {
    std::filesystem::path file;
    std::string error;  ///< Why it cannot be read; empty where it could.
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 0;
    std::string color_tag;  ///< Empty where the file says nothing of colours.
    NormalMapCheck check;
    double milliseconds = 0.0;  ///< Of the check, without reading.

    [[nodiscard]] bool is_sound() const { return error.empty() && !check.has_trouble(); }
};

/// Reads and checks. A file that cannot be read has an `error`.
///
/// \param green  which way green should grow; else what the file says counts
CheckedMap check_map(const std::filesystem::path& file, std::optional<Green> green);

void print_text(const CheckedMap& map);
nlohmann::ordered_json json_of(const CheckedMap& map);

}  // namespace relief::tools
