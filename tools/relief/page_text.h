// SPDX-License-Identifier: Apache-2.0
/// \file
/// The pages of `relief make` from the parts in page/. Tests: tests/make/make_page_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "relief/mesh/image.h"

namespace relief::tools {

/// Returns a file of page/. \param name  of an existing one
std::string_view page_part(std::string_view name);

/// Returns a file of page/ with each {{name}} replaced by its text.
std::string filled_page(std::string_view name, const std::map<std::string, std::string>& texts);

/// Returns an element with the picture inside.
/// \param id  may be empty
/// \param folder  for a temporary file
std::string html_image(const Image& image, const std::string& alt, const std::string& id,
                       const std::filesystem::path& folder);

}  // namespace relief::tools
