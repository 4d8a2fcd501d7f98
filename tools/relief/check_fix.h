// SPDX-License-Identifier: Apache-2.0
/// \file
/// Runs the remedies of `relief check --fix`. Tests: tests/check/check_fix_test.cpp.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "check_project.h"
#include "check_report.h"

namespace relief::tools {

/// Runs the remedies of errors and warnings, each once for a file, in an order in which no one
/// undoes another. They run as processes without a shell, so that file names have no meaning.
///
/// An embedded image is replaced by a PNG for all materials that show it. Then the fixed files are
/// checked again: findings that remain, and errors and warnings of other rules, are errors of the
/// fix.
///
/// \param folder  of the fixed copies, which have the names of the files in it; absent: the files
///         themselves are replaced
/// \return models first. If a remedy fails, the file stays as the one before it left
/// it
std::vector<CheckFix> fix_files(const std::vector<CheckedItem>& items,
                                const std::optional<std::filesystem::path>& folder,
                                const CheckProject& project);

}  // namespace relief::tools
