// SPDX-License-Identifier: Apache-2.0
/// \file
/// The models and images in folders, and the pairs of both by name.
/// Tests: tests/check/check_walk_test.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "check_item.h"

namespace relief::tools {

/// A file to check.
struct CheckInput {
    std::filesystem::path file;
    CheckedKind kind = CheckedKind::model;
    /// The images beside a model whose name is that of the model and a word for the kind of the
    /// map, "rock_normal.png" for "rock.obj".
    std::vector<UsedImage> paired;
};

struct WalkedFiles {
    std::vector<CheckInput> files;      ///< Sorted by name in each folder; each file once.
    std::vector<CheckedItem> findings;  ///< Of folders and links that are not entered.
};

/// Finds all models and images in folders and below, and the given files. Hidden folders, and
/// links to folders, are not entered; a link to a file counts as the file.
///
/// \param excludes  returns whether a file or a folder is left out
/// \throws UsageError if a given file is neither a model nor an image by its extension
WalkedFiles walk_files(const std::vector<std::filesystem::path>& given,
                       const std::function<bool(const std::filesystem::path&)>& excludes);

/// Returns what a file is by its extension; nothing if it is neither a model nor an image.
std::optional<CheckedKind> kind_by_name(const std::filesystem::path& file);

/// Returns whether a path with '/' matches a pattern: '*' stands for any letters but '/', '?' for
/// one of them, and "**" for any letters. A pattern without '/' is for the name alone.
bool matches_pattern(std::string_view path, std::string_view pattern);

}  // namespace relief::tools
