// SPDX-License-Identifier: Apache-2.0
/// \file
/// The options of a command line as typed, for commands that record or repeat them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace relief::tools {

/// An option with its values; a flag has none.
struct GivenOption {
    std::string name;  ///< "--size"
    std::vector<std::string> values;
};

/// Returns the options that a command line has, in the order of the help page.
/// \param left_out  names of options that are not returned
std::vector<GivenOption> given_options(const CLI::App& app,
                                       std::span<const std::string_view> left_out);

}  // namespace relief::tools
