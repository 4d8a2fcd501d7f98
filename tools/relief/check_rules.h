// SPDX-License-Identifier: Apache-2.0
/// \file
/// The rules of `relief check`: one table, from which the findings, `--rules`, SARIF and
/// docs/check-rules.md derive. Tests: tests/check/check_rules_test.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relief/mesh/diagnose.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/normal_map_check.h"

namespace relief {
namespace tools {

/// The severity of a finding. Notes also apply to sound files; SARIF has the same names.
enum class CheckSeverity { off, note, warning, error };

}  // namespace tools

template <>
inline constexpr auto enum_names<tools::CheckSeverity> =
    std::to_array<EnumName<tools::CheckSeverity>>({{"off", tools::CheckSeverity::off},
                                                   {"note", tools::CheckSeverity::note},
                                                   {"warning", tools::CheckSeverity::warning},
                                                   {"error", tools::CheckSeverity::error}});

namespace tools {

/// A rule. Its id never changes; a rule that is given up keeps its row.
struct CheckRule {
    std::string_view id;  ///< "mesh/repeated-triangle"
    CheckSeverity severity = CheckSeverity::note;
    std::string_view title;
    std::string_view cause;  ///< The usual origin.
    std::string_view cost;   ///< What goes wrong.
    /// A command with the words IN and OUT for the file and its fixed copy, which --fix runs; or
    /// advice.
    std::string_view remedy;
    /// The library's condition of which the rule is.
    std::optional<MeshCondition> of_mesh = std::nullopt;
    std::optional<MapCondition> of_map = std::nullopt;

    /// Returns whether --fix can run the remedy.
    [[nodiscard]] bool is_fixable() const { return remedy.find(" IN OUT") != remedy.npos; }
};

/// All rules, by id.
std::span<const CheckRule> check_rules();

/// Returns a rule; null if there is none of this id.
const CheckRule* find_check_rule(std::string_view id);

/// The rules of the library's conditions.
const CheckRule& check_rule_of(MeshCondition condition);
const CheckRule& check_rule_of(MapCondition condition);

/// Returns docs/check-rules.md.
std::string check_rules_page();

}  // namespace tools
}  // namespace relief
