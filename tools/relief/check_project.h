// SPDX-License-Identifier: Apache-2.0
/// \file
/// The file relief.json of a project: severities, suppressions, budgets and the baseline of
/// `relief check`; docs/check.md has its schema. Tests: tests/check/check_project_test.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "check_item.h"

namespace relief::tools {

/// Limits of the files that match a pattern; absent ones do not limit.
struct CheckBudget {
    std::vector<std::string> files;
    std::optional<double> triangles;
    std::optional<double> materials;
    std::optional<double> map_size;   ///< Texels along the longer side.
    std::optional<double> memory;     ///< Bytes on the GPU.
    std::optional<double> file_size;  ///< Bytes.
    /// Texels per unit of length of the scene.
    std::optional<double> min_density;
    std::optional<double> max_density;
};

struct CheckSuppression {
    std::string rule;  ///< A pattern.
    std::vector<std::string> files;
};

/// A finding that is accepted for now.
struct BaselineEntry {
    std::string rule;
    std::string file;
    std::string place;

    auto operator<=>(const BaselineEntry&) const = default;
};

struct CheckProject {
    std::filesystem::path file;  ///< Empty: there is none.
    /// The folder to which names of files are relative; "" for the current one.
    std::filesystem::path folder;
    std::vector<std::string> exclude;
    /// Patterns of rules with their severities; later ones win.
    std::vector<std::pair<std::string, CheckSeverity>> severities;
    std::vector<CheckSuppression> suppressions;
    std::vector<CheckBudget> budgets;
    /// The counts of accepted findings: those that have grown are reported again.
    std::map<BaselineEntry, std::size_t> baseline;

    /// Returns the name of a file for patterns and the baseline, with '/'.
    [[nodiscard]] std::string name_of(const std::filesystem::path& path) const;
    [[nodiscard]] bool excludes(const std::filesystem::path& path) const;
};

/// Reads the file. \throws FileError with the location of what is wrong in it
CheckProject read_check_project(const std::filesystem::path& file);

/// The number of findings that a project removes.
struct RemovedFindings {
    std::size_t suppressed = 0;
    std::size_t in_baseline = 0;
};

/// Adds what exceeds the budgets, sets the severities, and removes findings that are suppressed,
/// off, or in the baseline.
/// \param images  the figures of all image files, by identity_of()
RemovedFindings apply(const CheckProject& project,
                      const std::map<std::filesystem::path, ImageFigures>& images,
                      CheckedItem& item);

/// Replaces the baseline of a file, which need not exist, by errors and warnings.
/// \throws FileError
void write_baseline(const CheckProject& project, const std::vector<CheckedItem>& items);

}  // namespace relief::tools
