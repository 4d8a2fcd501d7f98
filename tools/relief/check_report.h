// SPDX-License-Identifier: Apache-2.0
/// \file
/// The outputs of `relief check`: text, JSON, SARIF, JUnit, annotations of GitHub and a page.
/// Tests: tests/check/check_report_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "check_item.h"
#include "relief/mesh/enum_names.h"

namespace relief {
namespace tools {

enum class CheckFormat { text, json, sarif, junit, github, html };

}  // namespace tools

template <>
inline constexpr auto enum_names<tools::CheckFormat> =
    std::to_array<EnumName<tools::CheckFormat>>({{"text", tools::CheckFormat::text},
                                                 {"json", tools::CheckFormat::json},
                                                 {"sarif", tools::CheckFormat::sarif},
                                                 {"junit", tools::CheckFormat::junit},
                                                 {"github", tools::CheckFormat::github},
                                                 {"html", tools::CheckFormat::html}});

namespace tools {

/// A finding that --fix should remove, and what a check of the fixed file found.
struct FixedFinding {
    std::string_view rule;
    std::string place;
    std::size_t count = 0;
    std::size_t remaining = 0;  ///< The count after the remedy.
};

/// The remedies that --fix ran on a file.
struct CheckFix {
    std::filesystem::path file;
    std::filesystem::path output;
    std::string command;
    std::string error;  ///< Empty if all findings are removed, and no others came.
    std::vector<FixedFinding> findings;
};

/// The results of all files.
struct CheckResults {
    std::vector<CheckedItem> items;  ///< In the order of the walk.
    std::size_t suppressed = 0;
    std::size_t in_baseline = 0;
    std::size_t from_cache = 0;
    std::vector<CheckFix> fixes;
    bool shows_notes = false;  ///< In text.

    [[nodiscard]] std::size_t count(CheckSeverity severity) const;
    [[nodiscard]] std::size_t unreadable() const;
};

/// Returns the command that remedies a finding, or advice; empty if there is none.
std::string remedy_text(const CheckedItem& item, const CheckFinding& finding);

/// Returns a file as an argument that does not begin with a dash.
std::filesystem::path as_argument(const std::filesystem::path& file);

/// Returns the results in a format but html.
std::string report_text(const CheckResults& results, CheckFormat format);

Json sarif_json(const CheckResults& results);

/// Writes the page, with pictures of the worst files. \throws FileError
void write_check_page(const std::filesystem::path& file, const CheckResults& results);

}  // namespace tools
}  // namespace relief
