// SPDX-License-Identifier: Apache-2.0
/// \file
/// Writes a scene as one HTML file, which draws the picture of relief-view with WebGL 2
/// (docs/page.md). Tests: tests/tools/view_page/.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/summary.h"
#include "page_images.h"
#include "page_quantize.h"
#include "page_scene.h"
#include "relief/shade/page.h"
#include "relief/shade/picture_steps.h"

namespace relief::tools {

/// The content of a picture of a page, for the controls.
struct PagePictureName {
    std::string view;
    std::string variant;
    std::optional<std::size_t> step = std::nullopt;  ///< Of PageSettings::steps.
    /// The picture to the left of the split line, of which this is the right.
    std::optional<std::size_t> left = std::nullopt;
    std::size_t scene = 0;  ///< Of PageSettings::scenes.
};

/// The line between the two sides of a comparison.
struct PageSplit {
    float position = 0.5F;  ///< From 0, the left edge, to 1.
    std::string left;       ///< The names of the sides.
    std::string right;
};

/// The parts of a page beside its description.
struct PageSettings {
    std::string title;
    std::vector<PagePictureName> names;  ///< Of the pictures, in their order; of the first ones.
    std::vector<PageScene> scenes;       ///< The first one has the camera of the page.
    double seconds = 0.0;
    std::vector<shade::PictureStep> steps;
    std::optional<PageSplit> split;
    /// The pictures without names are the first one at these times: their values of uniforms are
    /// those of the first one then.
    std::vector<double> motion_times;
    std::vector<Json> probes;  ///< page_probe_json()
    /// Normal maps that were computed from them are stored as these heights.
    std::optional<PageHeights> heights;
    /// The size of the command line's picture; narrower windows show as much to the sides.
    glm::ivec2 size{1, 1};
};

/// Returns the text of the page.
/// \param codes  vertex attributes that replace those of the description
std::string page_html(const shade::PageDescription& page, const PageSettings& settings,
                      const PageQuantization& codes = {});

/// Returns the page's script: all files of runtime/ but page.html and page.css.
std::string page_script();

/// Returns a page with this data, in base64. Without data it is the page's own code.
std::string page_frame(const std::string& title, const std::string& data);

/// A file of the folder runtime/.
struct PagePart {
    std::string_view name;
    std::string_view text;
};
/// All files of runtime/, sorted by name. cmake/embed_files.cmake generates this function.
const std::vector<PagePart>& page_parts();

}  // namespace relief::tools
