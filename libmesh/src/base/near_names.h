// SPDX-License-Identifier: Apache-2.0
/// \file
/// Suggestions for mistyped names.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {
namespace detail {

/// The known names that are nearest to an unknown one, nearest first, at most three.
///
/// A name is near if few letters must be inserted, removed or changed (at most three, and at most a
/// third of the longer name; case and separators are ignored), or if it contains the wanted name as
/// a word.
std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> known);

/// "; did you mean 'gold' or 'polished gold'?", or "" if no name is near.
std::string did_you_mean(std::string_view wanted, std::span<const std::string> known);

}  // namespace detail
}  // namespace relief
