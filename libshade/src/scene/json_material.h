// SPDX-License-Identifier: Apache-2.0
/// \file
/// Materials and textures of scene files. Tests: tests/shade/scene/scene_json_test.cpp.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "json_cursor.h"
#include "relief/shade/scene.h"
#include "scene/json_words.h"

namespace relief {

/// \throws InvalidInput at the cursor's place, with all names
template <typename Value, std::size_t count>
Value one_of(const JsonCursor& cursor, const Named<Value> (&names)[count]) {
    std::vector<std::string> known;
    for (const Named<Value>& entry : names) {
        if (cursor.text() == entry.name) return entry.value;
        known.emplace_back(entry.name);
    }
    cursor.fail_unknown(cursor.text(), known);
}

/// A linear color: three numbers, one number for gray, or "#rrggbb", which is sRGB-coded.
glm::vec3 color_in(const JsonCursor& cursor);

/// The images of a scene by their files, each once.
class JsonImages {
  public:
    /// \param scene_file  in whose folder relative paths begin
    JsonImages(const std::filesystem::path& scene_file, std::vector<ImageSource>& images)
        : scene_file_(scene_file), folder_(scene_file.parent_path()), images_(images) {}

    /// The file that a string names. \throws InvalidInput if it is not there
    [[nodiscard]] std::filesystem::path file(const JsonCursor& cursor) const;
    /// The folder that a string names, there or not.
    [[nodiscard]] std::filesystem::path folder(const JsonCursor& cursor) const;
    [[nodiscard]] ImageSource source(const JsonCursor& cursor) const;
    /// A texture of an image that may be missing: the Renderer finds out.
    Texture texture(const JsonCursor& cursor);

  private:
    [[nodiscard]] std::size_t own_image(const JsonCursor& number) const;

    std::filesystem::path scene_file_;
    std::filesystem::path folder_;
    std::vector<ImageSource>& images_;
    std::map<std::filesystem::path, std::size_t> index_of_;
};

/// Sets what an object says of a material, every member by its name in Material; "like" starts
/// from the classic table instead. \throws InvalidInput at the first offence
void read_material(const JsonCursor& object, JsonImages& images, Material& material);

}  // namespace relief
