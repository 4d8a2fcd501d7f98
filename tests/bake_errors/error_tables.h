// SPDX-License-Identifier: Apache-2.0
/// \file
/// The tables of docs/bake.md: how far baked maps are from the truth by samples and depth, what the
/// directions of rays lose and skew, and how many mip levels padding protects. Times are not in
/// them, but rays.
#pragma once

#include <string>

#include "support/error_page.h"

namespace relief::test {

// Markdown. The same on every machine and for every compiler.
std::string sample_tables();
std::string direction_tables();
std::string padding_tables();

/// All of them, each with the line before it in the page.
inline std::vector<PageSection> bake_tables() {
    return {{"<!-- tables of samples: written by relief-bake-errors-page -->\n",
             sample_tables() + "\n"},
            {"<!-- tables of directions: written by relief-bake-errors-page -->\n",
             direction_tables() + "\n"},
            {"<!-- tables of padding: written by relief-bake-errors-page -->\n",
             padding_tables() + "\n"}};
}

}  // namespace relief::test
