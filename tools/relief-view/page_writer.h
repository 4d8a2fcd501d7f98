// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writes a scene as one HTML file, which draws the picture of relief-view with WebGL 2
/// (docs/page.md). Tests: tests/tools/view_page/.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "page_quantize.h"
#include "relief/shade/page.h"
#include "scene_options.h"

namespace relief::tools {

/// The names of a picture of a page, in the controls.
struct PagePictureName {
    std::string view;
    std::string variant;
};

/// Returns the text of the page.
/// \param composed  the scene at the time of the pictures
/// \param names     of the pictures, in their order
/// \param aspect    width / height of the picture; narrower windows show as much to the sides
/// \param codes     vertex attributes that replace those of the description
std::string page_html(const shade::PageDescription& page, const ComposedScene& composed,
                      const std::vector<PagePictureName>& names, const std::string& title,
                      double seconds, double aspect, const PageQuantization& codes = {});

/// Returns a script or style sheet without comments, indentation and empty lines.
std::string without_comments(std::string_view code);

/// Returns the page's code: all files of page/ but page.html and page.css.
std::string page_script();

/// A file of the folder page/.
struct PagePart {
    std::string_view name;
    std::string_view text;
};
/// All files of page/, sorted by name. cmake/embed_files.cmake generates this function.
const std::vector<PagePart>& page_parts();

}  // namespace relief::tools
