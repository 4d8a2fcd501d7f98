// SPDX-License-Identifier: Apache-2.0
/// \file
/// The files of page/, which cmake/embed_files.cmake embeds in the tool.
#pragma once

#include <string_view>
#include <vector>

namespace relief::tools {

/// A file of the folder page/.
struct MakePagePart {
    std::string_view name;
    std::string_view text;
};

/// All files of page/.
const std::vector<MakePagePart>& make_page_parts();

}  // namespace relief::tools
