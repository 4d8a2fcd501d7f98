// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/dropped_files_test.cpp.
#include "window/dropped_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "common/text.h"

namespace relief::tools {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

template <std::size_t count>
bool says(const std::string& stem, const std::array<std::string_view, count>& words,
          std::string_view ending) {
    const bool has_word = std::any_of(words.begin(), words.end(), [&](std::string_view word) {
        return stem.find(word) != std::string::npos;
    });
    const bool ends = !ending.empty() && stem.size() >= ending.size() &&
                      stem.compare(stem.size() - ending.size(), ending.size(), ending) == 0;
    return has_word || ends;
}

}  // namespace

DroppedAs dropped_as(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 7> models = {".glb", ".gltf", ".obj", ".ply",
                                                               ".stl", ".off",  ".json"};
    const std::string extension = extension_of(file);
    if (std::find(models.begin(), models.end(), extension) != models.end()) return DroppedAs::model;
    if (extension == ".hdr" || std::filesystem::is_directory(file)) return DroppedAs::environment;
    using Words = std::array<std::string_view, 3>;
    const std::string stem = lower(file.stem().string());
    if (says(stem, Words{"normal", "nrm", "norm_"}, "_n")) return DroppedAs::normal_map;
    if (says(stem, Words{"height", "bump", "disp"}, "_h")) return DroppedAs::height_map;
    if (says(stem, Words{"env", "pano", "sky"}, "")) return DroppedAs::environment;
    return DroppedAs::diffuse_map;
}

ViewOptions with_dropped(ViewOptions options, const std::filesystem::path& file) {
    switch (dropped_as(file)) {
        case DroppedAs::model:
            options.model = file;
            break;
        case DroppedAs::height_map:
            options.height_map = file;
            options.normal_map.reset();
            break;
        case DroppedAs::normal_map:
            options.normal_map = file;
            options.height_map.reset();
            break;
        case DroppedAs::diffuse_map:
            options.diffuse_map = file;
            break;
        case DroppedAs::environment:
            options.environment = {file};
            break;
    }
    return options;
}

}  // namespace relief::tools
