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

bool ends(const std::string& text, std::string_view ending) {
    return !ending.empty() && text.size() >= ending.size() &&
           text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

template <std::size_t count>
bool says(const std::string& stem, const std::array<std::string_view, count>& words,
          std::string_view ending) {
    const bool has_word = std::any_of(words.begin(), words.end(), [&](std::string_view word) {
        return stem.find(word) != std::string::npos;
    });
    return has_word || ends(stem, ending);
}

/// Six files in the order +x -x +y -y +z -z, by one of the ways to name them; none: not so named.
std::vector<std::filesystem::path> faces_by_name(const std::vector<std::filesystem::path>& files) {
    using Names = std::array<std::string_view, 6>;
    for (const Names& names : {Names{"posx", "negx", "posy", "negy", "posz", "negz"},
                               Names{"px", "nx", "py", "ny", "pz", "nz"},
                               Names{"right", "left", "top", "bottom", "front", "back"}}) {
        std::vector<std::filesystem::path> faces;
        for (const std::string_view name : names) {
            const auto face = std::find_if(files.begin(), files.end(), [&](const auto& file) {
                return ends(lower(file.stem().string()), name);
            });
            if (face != files.end()) faces.push_back(*face);
        }
        if (faces.size() == names.size()) return faces;
    }
    return {};
}

/// What cannot be looked at is none; reading it says why.
bool is_folder(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_directory(file, error);
}

bool are_images(const std::vector<std::filesystem::path>& files) {
    return std::none_of(files.begin(), files.end(), [](const auto& file) {
        return dropped_as(file) == DroppedAs::model || is_folder(file);
    });
}

void drop_one(ViewOptions& options, const std::filesystem::path& file) {
    switch (dropped_as(file)) {
        case DroppedAs::model:
            options.model = file;
            // Where the camera stood was another model's place.
            if (options.camera && options.camera->place) options.camera.reset();
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
}

}  // namespace

DroppedAs dropped_as(const std::filesystem::path& file) {
    static constexpr std::array<std::string_view, 7> models = {".glb", ".gltf", ".obj", ".ply",
                                                               ".stl", ".off",  ".json"};
    const std::string extension = extension_of(file);
    if (std::find(models.begin(), models.end(), extension) != models.end()) return DroppedAs::model;
    if (extension == ".hdr" || is_folder(file)) return DroppedAs::environment;
    using Words = std::array<std::string_view, 3>;
    const std::string stem = lower(file.stem().string());
    if (says(stem, Words{"normal", "nrm", "norm_"}, "_n")) return DroppedAs::normal_map;
    if (says(stem, Words{"height", "bump", "disp"}, "_h")) return DroppedAs::height_map;
    if (says(stem, Words{"env", "pano", "sky"}, "")) return DroppedAs::environment;
    return DroppedAs::diffuse_map;
}

ViewOptions with_dropped(ViewOptions options, const std::vector<std::filesystem::path>& files) {
    if (files.size() == 6 && are_images(files)) {
        options.environment = faces_by_name(files);
        if (!options.environment.empty()) return options;
        options.environment = files;
        std::sort(options.environment.begin(), options.environment.end());
        return options;
    }
    for (const std::filesystem::path& file : files)
        drop_one(options, file);
    return options;
}

}  // namespace relief::tools
