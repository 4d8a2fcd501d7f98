// SPDX-License-Identifier: Apache-2.0
/// \file
/// --wrap WORD[,WORD]: what lies beyond a map's border, across and up and down.
/// Tests: tests/tools/relief_bake_test.cpp, relief_bake_heights_test.cpp, convert_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "common/options.h"
#include "relief/mesh/bump.h"

namespace relief::tools {

/// What was asked for along each axis. Absent: whatever the map itself shows.
struct WrapsOrAuto {
    std::optional<Wrap> x, y;

    [[nodiscard]] bool is_settled() const { return x && y; }
    [[nodiscard]] Wraps value_or(const Wraps& shown) const {
        return {x.value_or(shown.x), y.value_or(shown.y)};
    }
};

/// For commands that can look at the map: takes the word "auto" as well.
AddedOption add_wrap(CLI::App& app, WrapsOrAuto& target, const std::string& description);

/// For commands that do not.
AddedOption add_wrap(CLI::App& app, std::optional<Wraps>& target, const std::string& description);

/// "repeat", or "repeat,clamp" where the axes differ.
std::string wrap_words(const Wraps& wraps);

}  // namespace relief::tools
