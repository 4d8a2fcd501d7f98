// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the command line says about comparing: --compare, --compare-to, --split.
/// Tests: tests/tools/compare_options_test.cpp.
#pragma once

#include <filesystem>
#include <optional>

#include "variant.h"

namespace relief::tools {

inline constexpr float usual_split = 0.5F;

struct CompareChoices {
    std::optional<Variant> variant;
    std::optional<std::filesystem::path> file;  ///< Another model or scene.
    std::optional<float> split;                 ///< The share of the picture that is as it is.

    [[nodiscard]] bool compares() const { return variant || file; }
};

}  // namespace relief::tools
