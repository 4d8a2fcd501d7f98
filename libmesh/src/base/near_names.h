// SPDX-License-Identifier: Apache-2.0
/// \file
/// What somebody may have meant who wrote a name that is not known.
/// Tests: tests/mesh/base/near_names_test.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// The known names nearest to one that is not, nearest first, at most three.
///
/// Near is what takes few letters inserted, left out or changed (at most three, and at most a third
/// of the longer name's; case and separators aside), or what contains the wanted name as a word.
std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> known);

/// "; did you mean 'gold' or 'polished gold'?", or nothing where nothing is near.
std::string did_you_mean(std::string_view wanted, std::span<const std::string> known);

}  // namespace relief
