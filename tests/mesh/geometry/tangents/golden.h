// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reference tangents: meshes with what the MikkTSpace reference implementation answers for them.
///
/// Read from the shared folder "golden", whose README gives the layout. Texture coordinates become
/// relief's (v down) here: v = 1 - vt.v.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "relief/mesh/mesh.h"

namespace relief::test {

struct Golden {
    std::string name;
    Mesh mesh;  ///< Triangles; quads are cut by MikkTSpace's rule.
    /// For every corner of the triangles, the reference's corner in the file.
    std::vector<std::size_t> file_corner;
    std::vector<glm::vec4> tangents;  ///< By file corner.
    std::vector<glm::vec4> reversed;  ///< The same, from faces in reverse order.

    /// Whether the reference has one answer at a file corner: same w, and within 0.01 degrees.
    [[nodiscard]] bool is_stable(std::size_t file_corner) const;

    /// Whether the reference has left a file corner as it was before it began: (1,0,0), w = -1,
    /// whatever the normal. It does where no group reaches a corner; that is no answer either.
    [[nodiscard]] bool is_untouched(std::size_t file_corner) const;
};

/// \throws std::runtime_error if a file is not as the README says
Golden read_golden(const std::filesystem::path& obj);

/// All golden meshes in a folder, by name.
std::vector<std::filesystem::path> golden_files(const std::filesystem::path& folder);

}  // namespace relief::test
