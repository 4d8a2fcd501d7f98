// SPDX-License-Identifier: Apache-2.0
// Six faces of a cube map in a folder. Files are gone through in order of name, so that messages do
// not depend on the file system. Tests: tests/shade/scene/environment_files_test.cpp.
#include "relief/shade/environment_files.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <set>

#include "relief/mesh/error.h"

namespace relief {

CubeFaces cube_faces_in(const std::filesystem::path& folder) {
    constexpr std::array<const char*, 6> ends = {"posx", "negx", "posy", "negy", "posz", "negz"};
    std::set<std::filesystem::path> files;
    std::error_code problem;
    for (const auto& entry : std::filesystem::directory_iterator(folder, problem))
        files.insert(entry.path());
    if (problem) throw FileError(folder, "cannot be read as a folder: " + problem.message());
    CubeFaces faces;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        std::optional<std::filesystem::path> found;
        for (const std::filesystem::path& file : files) {
            if (!file.stem().string().ends_with(ends[i])) continue;
            if (found) {
                throw FileError(folder, fmt::format("both {} and {} end in {} (name the six files "
                                                    "instead)",
                                                    found->filename().string(),
                                                    file.filename().string(), ends[i]));
            }
            found = file;
        }
        if (!found) {
            throw FileError(folder, fmt::format("no file whose name ends in {} (name the six files "
                                                "in the order +x -x +y -y +z -z)",
                                                ends[i]));
        }
        faces.faces[i] = {found->string(), *found};
    }
    return faces;
}

}  // namespace relief
