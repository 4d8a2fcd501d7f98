// SPDX-License-Identifier: Apache-2.0
/// \file
/// A small report with special cases: errors of zero or NaN, methods without times, names that look
/// like HTML, pictures.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief::tools {

/// Returns sample_report.json, and writes its pictures below `folder`.
inline nlohmann::ordered_json sample_report(const std::filesystem::path& folder) {
    std::filesystem::create_directory(folder / "pictures");
    for (const char* name : {"heat", "before", "after"}) {
        Image image = make_image(64, 48, 3, 8, ColorSpace::srgb);
        std::fill(image.as<std::uint8_t>().begin(), image.as<std::uint8_t>().end(),
                  static_cast<std::uint8_t>(name[0]));
        write_image(folder / "pictures" / (std::string(name) + ".png"), image);
    }
    std::ifstream file(test::source_directory() / "tests/tools/accuracy_page/sample_report.json");
    return nlohmann::ordered_json::parse(file);
}

}  // namespace relief::tools
